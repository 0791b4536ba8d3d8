// What of a scene lies beside Lua's heap: generators, the beat of timers, counts.
#include "script/scene_key.h"

#include "script/behavior_scripts.h"
#include "script/context.h"
#include "script/scene.h"
#include "script/vm.h"

namespace limber {

void SceneKey::take(Scene& scene, PageStore& pages, const SceneKey* before, KeyBytes& scratch) {
  scene.vm_->copy_heap(pages, before == nullptr ? nullptr : &before->heap_, heap_);
  scratch.begin_taking();
  pass(scratch, *scene.context_);
  scene.vm_->pass_counts(scratch);
  own_size_ = scratch.bytes().size();
  own_.clear();
  pages.append(own_, scratch.bytes(), before == nullptr ? nullptr : &before->own_);
}

void SceneKey::bring_back(Scene& scene, const PageStore& pages, KeyBytes& scratch) const {
  scene.vm_->bring_back_heap(pages, heap_);
  scratch.bytes().resize(own_size_);
  pages.copy_back(own_, 0, scratch.bytes());
  scratch.begin_bringing();
  pass(scratch, *scene.context_);
  scene.vm_->pass_counts(scratch);
}

void SceneKey::release(PageStore& pages) {
  pages.release(heap_);
  pages.release(own_);
}

void SceneKey::pass(KeyBytes& key, ScriptContext& context) {
  key.pass_all(context.random, context.seeded_with, context.timers_at, context.handlers);
  context.behaviors->pass_memory(key);
}

}  // namespace limber
