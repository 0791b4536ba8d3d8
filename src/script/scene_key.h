// SceneKey: a scene between two ticks: Lua's whole heap, generators, timers, to be brought back to the bit. [sim]
#pragma once

#include "base/key_bytes.h"
#include "base/page_store.h"

namespace limber {

class Scene;
struct ScriptContext;

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
  static void pass(KeyBytes& key, ScriptContext& context);

  PageStore::Image heap_, own_;
  std::size_t own_size_ = 0;
};

}  // namespace limber
