// ReloadCandidate: a run of the scene detached from the show.
#include "engine/reload/reload_candidate.h"

#include <utility>

#include "engine/presets/capturer.h"

namespace limber {

ReloadCandidate::ReloadCandidate(ReloadRequest request, ScriptHost& host)
    : request_(std::move(request)), scene_(std::make_unique<Scene>(world_, host, request_.options)) {
  result_ = scene_->run(request_.file, &request_.inputs);
  if (!result_) return;
  world_.flush_detached();
  spec_ = std::make_shared<const SceneSpec>(describe(world_));
  diff_ = compare(*request_.base_spec, *spec_);
  script_preset_ = PresetCapturer::capture_script(store_);
  index_slots();
  scene_->prepare();
}

std::vector<SourceFile> ReloadCandidate::files() const { return scene_->sources()->files(); }

void ReloadCandidate::index_slots() {
  slots_.resize(store_.view()->slot_count);
  const auto set_slot = [&](NodeId id, Kind kind, std::size_t owner, std::size_t index = 0) {
    slots_[id.slot] = {kind, static_cast<std::uint32_t>(owner), static_cast<std::uint32_t>(index)};
  };
  const auto set_slots = [&](const auto& list, Kind kind, std::size_t owner) {
    for (std::size_t i = 0; i < list.size(); i++) set_slot(list[i]->id(), kind, owner, i);
  };
  set_slot(world_.id(), Kind::world, 0);
  set_slot(world_.visuals().id(), Kind::visuals, 0);
  set_slot(world_.visuals().camera().id(), Kind::camera, 0);
  set_slot(world_.visuals().appearance().id(), Kind::appearance, 0);
  for (std::size_t i = 0; i < world_.shapes().size(); i++) set_slot(world_.shapes()[i]->id(), Kind::shape, i);
  for (std::size_t i = 0; i < world_.bodies().size(); i++) {
    const Body& body = *world_.bodies()[i];
    set_slot(body.id(), Kind::body, i);
    set_slots(body.parts(), Kind::part, i);
    set_slots(body.joints(), Kind::joint, i);
    set_slots(body.motors(), Kind::motor, i);
    set_slots(body.behaviors(), Kind::behavior, i);
  }
  set_slots(world_.gears(), Kind::gear, 0);
  set_slots(world_.behaviors().groups(), Kind::group, 0);
}

NodeId ReloadCandidate::live_id(NodeId id, const World& live, const std::vector<NodeId>& shapes,
                                const std::vector<NodeId>& bodies) const {
  if (id.slot >= slots_.size()) return {};
  const auto id_of = [](const auto* object) { return object == nullptr ? NodeId{} : object->id(); };
  const SlotObject slot = slots_[id.slot];
  if (slot.kind == Kind::none) return {};
  if (slot.kind == Kind::world) return live.id();
  if (slot.kind == Kind::visuals) return live.visuals().id();
  if (slot.kind == Kind::camera) return live.visuals().camera().id();
  if (slot.kind == Kind::appearance) return live.visuals().appearance().id();
  if (slot.kind == Kind::shape) return shapes[slot.owner];
  if (slot.kind == Kind::gear) return id_of(live.find_gear(spec_->gears[slot.index].name));
  if (slot.kind == Kind::group) return id_of(live.behaviors().find_group(spec_->groups[slot.index].name));
  const NodeId body_id = bodies[slot.owner];
  if (slot.kind == Kind::body) return body_id;
  const Body& body = *static_cast<const Body*>(live.store().object(body_id));
  if (slot.kind == Kind::behavior)
    return id_of(body.find_behavior(spec_->bodies[slot.owner].behaviors[slot.index].name));
  if (slot.kind == Kind::part) return body.parts()[slot.index]->id();
  if (slot.kind == Kind::joint) return body.joints()[slot.index]->id();
  return body.motors()[slot.index]->id();
}

}  // namespace limber
