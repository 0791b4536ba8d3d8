// SceneKey: a scene between two ticks: Lua's whole heap, generators, timers, to be brought back to the bit. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/key_bytes.h"
#include "base/page_store.h"

namespace limber {

class Scene;
class Vm;

class SceneKey {
 public:
  /// Takes the scene as it is, in pages that are shared with `before`, an older key of it, or null. `scratch` is used
  /// again and again.
  void take(Scene& scene, PageStore& pages, const SceneKey* before, KeyBytes& scratch);
  /// The scene is as it was taken; it is the same run of it.
  void bring_back(Scene& scene, const PageStore& pages, KeyBytes& scratch) const;
  /// Gives its pages back.
  void release(PageStore& pages);

 private:
  /// One Lua state: its heap, and the numbers beside it.
  struct State {
    PageStore::Image heap, own;
    std::size_t own_size = 0;
  };
  struct EarlierState {
    std::uint64_t number = 0;  // of the run
    State state;
  };
  template <class Beside>
  static void take(State& to, Vm& vm, PageStore& pages, const State* before, KeyBytes& scratch, Beside pass);
  template <class Beside>
  static void bring_back(const State& from, Vm& vm, const PageStore& pages, KeyBytes& scratch, Beside pass);

  State state_;
  std::vector<EarlierState> earlier_;  // runs with timers that go on
};

}  // namespace limber
