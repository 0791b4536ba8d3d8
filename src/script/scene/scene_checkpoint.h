// SceneCheckpoint: the exact state of a scene between two ticks: Lua's heap, generators, timers. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/memory/archive.h"
#include "base/memory/page_store.h"

namespace limber::script {

class Scene;
class Vm;

class SceneCheckpoint {
 public:
  /// Captures the scene, sharing pages with the older checkpoint `previous` (may be null). `scratch` is a reusable
  /// buffer.
  void capture(Scene& scene, PageStore& pages, const SceneCheckpoint* previous, Archive& scratch);
  /// Restores the captured state. The scene must be the same run.
  void restore(Scene& scene, const PageStore& pages, Archive& scratch) const;
  /// Releases its pages.
  void release(PageStore& pages);

 private:
  /// One Lua state: its heap, and the serialized data outside the heap.
  struct State {
    PageStore::PageList heap, extra;
    std::size_t extra_size = 0;
  };
  struct EarlierState {
    std::uint64_t number = 0;  // sequence number of the run
    State state;
  };
  template <class SerializeExtra>
  static void capture(State& to, Vm& vm, PageStore& pages, const State* previous, Archive& scratch,
                      SerializeExtra serialize_extra);
  template <class SerializeExtra>
  static void restore(const State& from, Vm& vm, const PageStore& pages, Archive& scratch,
                      SerializeExtra serialize_extra);

  State state_;
  std::vector<EarlierState> earlier_;  // earlier runs with pending timers
};

}  // namespace limber::script
