// Running a scene beside the show.
#include "engine/draft.h"

#include <utility>

#include "engine/preset_taker.h"

namespace limber {

Draft::Draft(DraftOrder order, ScriptHost& host)
    : order_(std::move(order)), scene_(std::make_unique<Scene>(world_, host, order_.options)) {
  ran_ = scene_->run(order_.file, &order_.inputs);
  if (!ran_) return;
  world_.stand();
  description_ = std::make_shared<const Description>(describe(world_));
  difference_ = compare(*order_.before, *description_);
  script_ = PresetTaker::take_script(store_);
  find_spots();
  scene_->prepare();
}

std::vector<SourceFile> Draft::files() const { return scene_->sources()->files(); }

void Draft::find_spots() {
  spots_.resize(store_.view()->slot_count);
  const auto put = [&](NodeId id, Kind kind, std::size_t owner, std::size_t number = 0) {
    spots_[id.slot] = {kind, static_cast<std::uint32_t>(owner), static_cast<std::uint32_t>(number)};
  };
  const auto put_all = [&](const auto& list, Kind kind, std::size_t owner) {
    for (std::size_t i = 0; i < list.size(); i++) put(list[i]->id(), kind, owner, i);
  };
  put(world_.id(), Kind::world, 0);
  put(world_.visuals().id(), Kind::visuals, 0);
  put(world_.visuals().camera().id(), Kind::camera, 0);
  put(world_.visuals().look().id(), Kind::look, 0);
  for (std::size_t i = 0; i < world_.shapes().size(); i++) put(world_.shapes()[i]->id(), Kind::shape, i);
  for (std::size_t i = 0; i < world_.bodies().size(); i++) {
    const Body& body = *world_.bodies()[i];
    put(body.id(), Kind::body, i);
    put_all(body.parts(), Kind::part, i);
    put_all(body.joints(), Kind::joint, i);
    put_all(body.motors(), Kind::motor, i);
    put_all(body.behaviors(), Kind::behavior, i);
  }
  put_all(world_.gears(), Kind::gear, 0);
  put_all(world_.behaviors().groups(), Kind::group, 0);
}

NodeId Draft::live_id(NodeId id, const World& live, const std::vector<NodeId>& shapes,
                      const std::vector<NodeId>& bodies) const {
  if (id.slot >= spots_.size()) return {};
  const Spot spot = spots_[id.slot];
  if (spot.kind == Kind::none) return {};
  if (spot.kind == Kind::world) return live.id();
  if (spot.kind == Kind::visuals) return live.visuals().id();
  if (spot.kind == Kind::camera) return live.visuals().camera().id();
  if (spot.kind == Kind::look) return live.visuals().look().id();
  if (spot.kind == Kind::shape) return shapes[spot.owner];
  if (spot.kind == Kind::gear) {
    const Gear* const gear = live.find_gear(description_->gears[spot.number].name);
    return gear == nullptr ? NodeId{} : gear->id();
  }
  if (spot.kind == Kind::group) {
    const BehaviorGroup* const group = live.behaviors().find_group(description_->groups[spot.number].name);
    return group == nullptr ? NodeId{} : group->id();
  }
  const NodeId of = bodies[spot.owner];
  if (spot.kind == Kind::body) return of;
  const Body& body = *static_cast<const Body*>(live.store().thing(of));
  if (spot.kind == Kind::behavior) {
    const Behavior* const behavior = body.find_behavior(description_->bodies[spot.owner].behaviors[spot.number].name);
    return behavior == nullptr ? NodeId{} : behavior->id();
  }
  if (spot.kind == Kind::part) return body.parts()[spot.number]->id();
  if (spot.kind == Kind::joint) return body.joints()[spot.number]->id();
  return body.motors()[spot.number]->id();
}

}  // namespace limber
