// Snapshots: a copy of the transient values, and a list of bodies, shared until bodies are added or removed.
#include "engine/output/publisher.h"

#include <algorithm>

#include "sim/behavior/behavior_list.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"

namespace limber::engine {

namespace {
/// Grain size of the parallel copy, in numbers.
constexpr int kCopyGrain = 1 << 14;
}  // namespace

const TransientOffsets& transient_offsets() {
  static const auto joint = [](const char* name) { return sim::Joint::table().at(name).offset; };
  static const auto part = [](const char* name) { return sim::Part::table().at(name).offset; };
  static const TransientOffsets offsets{joint("position"), joint("rotation"), joint("relrot"),
                                        joint("offsets"),  part("position"),  part("rotation")};
  return offsets;
}

Pose part_pose(const Snapshot& snapshot, std::uint32_t part_offset) {
  const double* const part = snapshot.transient.data() + part_offset;
  return {vec3_at(part + transient_offsets().part_position), quat_at(part + transient_offsets().part_rotation)};
}

void Publisher::update_body_list() {
  auto body_list = std::make_shared<BodyList>();
  const StoreView& view = *world_.store().view();
  const auto block_of = [&](NodeId id) { return view.slots[id.slot].transient; };
  body_list->bodies.reserve(world_.bodies().size());
  for (const auto& body : world_.bodies()) {
    BodyEntry& entry = body_list->bodies.emplace_back();
    entry.name = body->name();
    entry.enabled_offset = block_of(body->id()) + sim::Body::table().at("enabled").offset;
    for (const auto& joint : body->joints()) {
      entry.joint_names.push_back(joint->name());
      entry.joint_offsets.push_back(block_of(joint->id()));
    }
    for (const auto& part : body->parts()) entry.part_offsets.push_back(block_of(part->id()));
  }
  body_list_ = std::move(body_list);
}

void Publisher::publish(bool paused, double speed_factor, const PhaseTimes& times, bool replayed) {
  if (body_list_ == nullptr || structure_version_ != world_.store().structure_version()) {
    update_body_list();
    render_scene_ = std::make_shared<const RenderScene>(world_);
    structure_version_ = world_.store().structure_version();
  }
  const std::shared_ptr<Snapshot> snapshot = out_.acquire_buffer();
  snapshot->tick = world_.tick();
  snapshot->time = world_.time();
  snapshot->paused = paused;
  snapshot->speed = speed_factor;
  snapshot->times = times;
  snapshot->body_list = body_list_;
  const std::span<const double> transient = world_.store().transient_values();
  snapshot->transient.resize(transient.size());
  parallel_for_ranges(
      world_.thread_pool(), static_cast<int>(transient.size()),
      [&](int, int first, int end) {
        std::copy(transient.begin() + first, transient.begin() + end, snapshot->transient.begin() + first);
      },
      kCopyGrain);
  const std::uint64_t version = world_.store().persistent_version();
  if (snapshot->render_scene != render_scene_ || snapshot->visuals_version != version) {
    render_scene_->copy_visuals(world_.store().persistent_values(), snapshot->visuals);
    snapshot->render_scene = render_scene_;
    snapshot->visuals_version = version;
  }
  snapshot->dmx = world_.visuals().fixtures().frame();
  snapshot->clock = world_.behaviors().clock().reading();
  snapshot->replayed = replayed;
  snapshot->overlay.clear();
  if (world_.visuals().overlay().on()) world_.visuals().overlay().collect(snapshot->overlay);
  out_.publish(snapshot);
}

}  // namespace limber::engine
