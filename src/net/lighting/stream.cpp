// LightStream: rates, repetitions, sequence numbers, and the end of universes.
#include "net/lighting/stream.h"

#include <algorithm>
#include <utility>

namespace limber::lighting {

bool ArmLatch::update(bool armed, bool replayed, std::uint64_t tick) {
  if (replayed || !in_real_time_) {
    permitted_ = lights_ && (armed || replayed);
  } else if (!armed) {
    permitted_ = false;
  } else {
    const bool earlier = tick < last_tick_;  // a rewind or a reset
    const bool armed_now = !last_armed_ && !earlier && !last_replayed_;
    if (first_ ? lights_ : armed_now) permitted_ = true;
    if (last_replayed_) permitted_ = false;  // a take that has ended does not leave lights on
  }
  first_ = false;
  last_armed_ = armed;
  last_replayed_ = replayed;
  last_tick_ = tick;
  return permitted_;
}

LightStream::LightStream(LightTarget target, const Cid& cid, Send send)
    : target_(std::move(target)),
      cid_(cid),
      send_(std::move(send)),
      interval_(static_cast<std::int64_t>(1e9 / target_.rate)) {}

LightStream::Universe& LightStream::universe(std::uint16_t number) {
  const auto found = std::ranges::find(universes_, number, &Universe::number);
  if (found != universes_.end()) return *found;
  Universe& added = universes_.emplace_back();
  added.number = number;
  if (const auto last = sequences_.find(number); last != sequences_.end()) added.sequence = last->second;
  return added;
}

// A serial port has one universe.
bool LightStream::sends(std::uint16_t universe) const {
  return target_.protocol != Protocol::enttec || universe == target_.universe;
}

void LightStream::assign(Universe& to, const sim::DmxUniverse& from, bool dark) {
  to.present = true;
  const std::array<std::uint8_t, sim::kDmxChannels>& values = dark ? from.dark : from.values;
  // once sent, channels stay in the packet, so that a receiver sees the value of each
  const std::uint16_t length = std::max(to.length, from.length);
  if (to.is_new || values != to.values || length != to.length) to.repeats = kRepeats + 1;
  to.values = values;
  to.dark = from.dark;
  to.length = length;
}

std::optional<std::int64_t> LightStream::update(const sim::DmxFrame& frame, std::int64_t now) {
  for (Universe& each : universes_) each.present = false;
  std::optional<std::int64_t> next;
  bool sent = false;
  const bool dark = frame.panicked && target_.dark_in_panic;
  for (const sim::DmxUniverse& from : frame.universes) {
    if (!sends(from.number)) continue;
    Universe& to = universe(from.number);
    assign(to, from, dark);
    const std::int64_t due = to.is_new ? now : to.sent + (to.repeats > 0 ? interval_ : kKeepAlive);
    if (due <= now) {
      send(to, to.values);
      to.is_new = false;
      to.repeats = std::max(0, to.repeats - 1);
      to.sent = now;
      sent = true;
    }
    const std::int64_t following = to.sent + (to.repeats > 0 ? interval_ : kKeepAlive);
    next = std::min(next.value_or(following), following);
  }
  for (Universe& each : universes_) {
    if (!each.present) end(each);
  }
  std::erase_if(universes_, [](const Universe& each) { return !each.present; });
  if (sent) send_sync();
  return next;
}

void LightStream::send(Universe& universe, const std::array<std::uint8_t, sim::kDmxChannels>& values, bool terminated) {
  system::Endpoint to = target_.to;
  if (target_.protocol == Protocol::enttec) {
    write_enttec({values.data(), universe.length}, packet_);
  } else if (target_.protocol == Protocol::art_net) {
    universe.sequence = universe.sequence == 255 ? std::uint8_t{1} : static_cast<std::uint8_t>(universe.sequence + 1);
    write_art_dmx(universe.number, universe.sequence, {values.data(), universe.length}, packet_);
  } else {
    if (to.ip == 0) to.ip = sacn_multicast(universe.number);
    write_sacn_data(
        {cid_, target_.name, universe.number, target_.priority, target_.sync, universe.sequence++, terminated}, values,
        packet_);
  }
  send_(to, packet_);
}

void LightStream::end(Universe& universe) {
  if (universe.is_new) return;
  if (target_.dark_at_end) {
    send(universe, universe.dark);
    const int terminations = target_.protocol == Protocol::sacn ? kRepeats : 0;
    for (int i = 0; i < terminations; i++) send(universe, universe.dark, true);
  }
  sequences_[universe.number] = universe.sequence;
}

void LightStream::end() {
  if (universes_.empty()) return;
  for (Universe& each : universes_) end(each);
  if (target_.dark_at_end) send_sync();
  universes_.clear();
}

void LightStream::send_sync() {
  if (target_.protocol != Protocol::sacn || target_.sync == 0) return;
  write_sacn_sync(cid_, target_.sync, sync_sequence_++, packet_);
  system::Endpoint to = target_.to;
  if (to.ip == 0) to.ip = sacn_multicast(target_.sync);
  send_(to, packet_);
}

}  // namespace limber::lighting
