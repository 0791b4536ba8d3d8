// Names of trackers become names of joints, so each is made unique among those of its sender.
#include "net/osc/psn/psn_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/math/fixed_math.h"
#include "base/text.h"

namespace limber::osc {

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();  // motion capture skips it

std::string default_name(std::uint16_t id) { return fmt::format("tracker_{}", id); }

std::string joint_name(std::string_view name, std::uint16_t id) {
  return name_error(name) ? default_name(id) : std::string(name);
}

// The quaternion of a turn about an axis, whose length is the angle.
Quat rotation_of(const Vec3& turn) {
  const double angle = glm::length(turn);
  if (!(angle > 1e-9)) return angle == angle ? quat_identity() : Quat(kAbsent, 0, 0, 0);
  const Vec3 axis = turn * (fixed::sin(angle / 2) / angle);
  return Quat(fixed::cos(angle / 2), axis.x, axis.y, axis.z);
}

Message message_of(const std::string& name, const PsnTracker& tracker) {
  const bool seen = !tracker.validity || *tracker.validity > 0;
  const Vec3 position = seen && tracker.position ? *tracker.position : Vec3(kAbsent);
  const Quat rotation = seen && tracker.rotation ? rotation_of(*tracker.rotation) : Quat(kAbsent, 0, 0, 0);
  Message message{PsnInput::kAddress, {Arg::of(name)}};
  for (const double number : {position.x, position.y, position.z, rotation.w, rotation.x, rotation.y, rotation.z,
                              tracker.validity ? static_cast<double>(*tracker.validity) : 1})
    message.args.push_back(Arg::of(number));
  return message;
}

}  // namespace

// Returns the state of the sender. A new one replaces the one that has been silent for the longest time.
PsnInput::Sender& PsnInput::sender_of(const system::IpAddress& ip, std::int64_t now) {
  auto found = std::ranges::find(senders_, ip, &Sender::ip);
  if (found == senders_.end()) {
    if (senders_.size() < kMaxSenders) {
      senders_.emplace_back();
      found = senders_.end() - 1;
    } else {
      found = std::ranges::min_element(senders_, {}, &Sender::last_seen);
    }
    *found = Sender{};
    found->ip = ip;
    found->first_seen = now;
  }
  found->last_seen = now;
  return *found;
}

void PsnInput::learn(Sender& sender, const std::vector<PsnTracker>& trackers) {
  for (const PsnTracker& tracker : trackers) {
    const auto known = sender.names.find(tracker.id);
    if (known == sender.names.end() && sender.names.size() >= kMaxNames) continue;
    if (known != sender.names.end()) sender.used_names.erase(known->second);
    std::string name = joint_name(tracker.name, tracker.id);
    while (!sender.used_names.insert(name).second) name += fmt::format("_{}", tracker.id);
    sender.names[tracker.id] = std::move(name);
  }
}

bool PsnInput::is_late(Sender& sender, std::uint64_t timestamp) {
  const bool late = sender.has_data && timestamp < sender.timestamp && sender.timestamp - timestamp < kMaxReordering;
  if (!late) sender.timestamp = timestamp;
  sender.has_data = true;
  return late;
}

Result<std::vector<Message>> PsnInput::translate(std::string_view bytes, const system::IpAddress& ip,
                                                 std::int64_t now) {
  Result<PsnPacket> packet = parse_psn(bytes);
  if (!packet) return Error{packet.error()};
  Sender& sender = sender_of(ip, now);
  std::vector<Message> messages;
  if (packet->kind == PsnPacket::Kind::info) {
    learn(sender, packet->trackers);
    return messages;
  }
  const bool waits = sender.names.empty() && now - sender.first_seen < kNameTimeout;
  if (is_late(sender, packet->timestamp) || waits) return messages;
  messages.reserve(packet->trackers.size());
  for (const PsnTracker& tracker : packet->trackers) {
    if (!tracker.position && !tracker.rotation && !tracker.validity) continue;
    const auto known = sender.names.find(tracker.id);
    messages.push_back(message_of(known == sender.names.end() ? default_name(tracker.id) : known->second, tracker));
  }
  return messages;
}

}  // namespace limber::osc
