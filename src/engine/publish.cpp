// Snapshots: a copy of the live block beside a roster that is shared while nobody comes or goes.
#include "engine/publish.h"

#include <algorithm>

namespace limber {

namespace {
/// Numbers that are copied at a time; it changes no result.
constexpr int kNumbers = 1 << 14;
}  // namespace

const LiveOffsets& live_offsets() {
  static const auto joint = [](const char* name) { return Joint::table().at(name).offset; };
  static const auto part = [](const char* name) { return Part::table().at(name).offset; };
  static const LiveOffsets offsets{joint("position"), joint("rotation"), joint("relrot"),
                                   joint("offsets"),  part("position"),  part("rotation")};
  return offsets;
}

void Publisher::renew_roster() {
  auto roster = std::make_shared<Roster>();
  const StoreView& view = *world_.store().view();
  const auto live_of = [&](NodeId id) { return view.slots[id.slot].live; };
  roster->bodies.reserve(world_.bodies().size());
  for (const auto& body : world_.bodies()) {
    RosterBody& entry = roster->bodies.emplace_back();
    entry.name = body->name();
    entry.enabled_at = live_of(body->id()) + Body::table().at("enabled").offset;
    for (const auto& joint : body->joints()) {
      entry.joint_names.push_back(joint->name());
      entry.joints.push_back(live_of(joint->id()));
    }
    for (const auto& part : body->parts()) entry.parts.push_back(live_of(part->id()));
  }
  roster_ = std::move(roster);
}

void Publisher::publish(bool paused, double speed_reached, const PhaseTimes& times) {
  if (roster_ == nullptr || structure_ != world_.store().structure_version()) {
    renew_roster();
    drawing_ = std::make_shared<const Drawing>(world_);
    structure_ = world_.store().structure_version();
  }
  const std::shared_ptr<Snapshot> snapshot = out_.spare();
  snapshot->tick = world_.tick();
  snapshot->time = world_.time();
  snapshot->paused = paused;
  snapshot->speed = speed_reached;
  snapshot->times = times;
  snapshot->roster = roster_;
  const std::span<const double> live = world_.store().live();
  snapshot->live.resize(live.size());
  share_out_places(
      world_.team(), static_cast<int>(live.size()),
      [&](int, int first, int end) {
        std::copy(live.begin() + first, live.begin() + end, snapshot->live.begin() + first);
      },
      kNumbers);
  const std::uint64_t version = world_.store().kept_version();
  if (snapshot->drawing != drawing_ || snapshot->visuals_version != version) {
    drawing_->copy_visuals(world_.store().kept(), snapshot->visuals);
    snapshot->drawing = drawing_;
    snapshot->visuals_version = version;
  }
  snapshot->overlay.clear();
  if (world_.overlay().on()) world_.overlay().gather(snapshot->overlay);
  out_.publish(snapshot);
}

}  // namespace limber
