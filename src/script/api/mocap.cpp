// C API: sources of motion capture.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/system/net/socket.h"
#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/mocap/mocap_list.h"

namespace limber::script::calls {

namespace {

struct MocapOption {
  enum : std::int32_t { file, dialect, dancer, up, handed, quaternion, joint, address, words, parent, child };
};

// The index of a word among those that an option accepts.
Result<std::size_t> choice_of(const std::string& text, std::string_view option, const std::vector<std::string>& words) {
  const auto found = std::ranges::find(words, text);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  return Error{fmt::format("{} has no value '{}'{}", option, printable(text), name_hint(text, words))};
}

constexpr std::string_view kPsn = "psn";

bool is_psn(const std::string& dialect) { return dialect == kPsn || dialect.starts_with("psn:"); }

// The address of "psn" or "psn:ADDR:PORT".
Result<ListenAddress> psn_address(const std::string& dialect) {
  ListenAddress address{"236.10.10.10", 56565, true};  // those of the protocol
  if (dialect == kPsn) return address;
  const std::vector<std::string_view> pieces = split(dialect, ':');
  const auto port = pieces.size() == 3 ? parse_number(pieces[2]) : std::nullopt;
  if (!port || *port != std::floor(*port) || *port < 1 || *port > 65535 || !system::parse_ipv4(std::string(pieces[1])))
    return Error{
        fmt::format("source '{}' must be psn or psn:ADDR:PORT, such as psn:236.10.10.10:56565", printable(dialect))};
  address.address = pieces[1];
  address.port = static_cast<std::uint16_t>(*port);
  return address;
}

// Sets the axes, for which each kind of source has its convention.
Result<void> set_mocap_axes(MocapArguments& arguments) {
  sim::MocapAxes& axes = arguments.setup.axes;
  const bool stage = arguments.dialect == "vmc" || is_psn(arguments.dialect);  // left-handed, Y up
  const bool y_up = stage || !arguments.file.empty();                          // of BVH files, too
  const Result<std::size_t> up_axis =
      choice_of(arguments.up.empty() ? (y_up ? "y" : "z") : arguments.up, "up", {"x", "y", "z"});
  if (!up_axis) return Error{up_axis.error()};
  axes.up = static_cast<sim::MocapAxes::Up>(*up_axis);
  const Result<std::size_t> hand =
      choice_of(arguments.handed.empty() ? (stage ? "left" : "right") : arguments.handed, "handed", {"right", "left"});
  if (!hand) return Error{hand.error()};
  axes.left_handed = *hand == 1;
  return {};
}

Result<void> complete_mocap_setup(ScriptContext& c) {
  MocapArguments& arguments = c.arguments.mocap;
  sim::MocapSetup& setup = arguments.setup;
  if (Result<void> axes = set_mocap_axes(arguments); !axes) return axes;
  const Result<std::size_t> order =
      choice_of(arguments.quaternion.empty() ? "wxyz" : arguments.quaternion, "quaternion", {"wxyz", "xyzw"});
  if (!order) return Error{order.error()};
  if (!arguments.dialect.empty())
    return sim::set_mocap_dialect(setup, is_psn(arguments.dialect) ? std::string(kPsn) : arguments.dialect,
                                  arguments.dancer, *order == 0);
  if (arguments.file.empty()) return {};
  const Result<std::string> path = c.sources->find(c.files, arguments.file);
  if (!path) return Error{path.error()};
  const Result<std::shared_ptr<const model::BvhClip>> clip = c.sources->clip(*path);
  if (!clip) return Error{clip.error()};
  setup.clip = *clip;
  return {};
}

}  // namespace

void mocap_begin(void* c) { context_of(c).arguments.mocap = {}; }

void mocap_option(void* c, std::int32_t which, const char* text, std::int32_t length) {
  MocapArguments& arguments = context_of(c).arguments.mocap;
  sim::MocapSetup& setup = arguments.setup;
  std::string value(text_of(text, length));
  std::string* const fields[] = {&arguments.file, &arguments.dialect, &arguments.dancer,
                                 &arguments.up,   &arguments.handed,  &arguments.quaternion};
  if (which >= MocapOption::file && which <= MocapOption::quaternion) {
    *fields[which] = std::move(value);
  } else if (which == MocapOption::joint) {
    setup.joints.push_back(std::move(value));
  } else if (which == MocapOption::address) {
    setup.messages.push_back({std::move(value), {}});
  } else if (which == MocapOption::words && !setup.messages.empty()) {
    setup.messages.back().words = std::move(value);
  } else if (which == MocapOption::parent) {
    setup.bones.push_back({std::move(value), {}});
  } else if (which == MocapOption::child && !setup.bones.empty()) {
    setup.bones.back().child = std::move(value);
  }
}

void mocap_number(void* c, std::int32_t which, double value) {
  sim::MocapSetup& setup = context_of(c).arguments.mocap.setup;
  if (which == 0) {
    setup.axes.unit = value;
  } else if (!setup.bones.empty()) {
    setup.bones.back().length = value;
  }
}

std::int32_t add_mocap(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  const std::string name_text(text_of(name, length));
  if (const Result<void> complete = complete_mocap_setup(context); !complete)
    return context.reject(fmt::format("mocap '{}': {}", printable(name_text), complete.error()));
  std::optional<ListenAddress> trackers;
  if (is_psn(context.arguments.mocap.dialect)) {
    const Result<ListenAddress> address = psn_address(context.arguments.mocap.dialect);
    if (!address) return context.reject(fmt::format("mocap '{}': {}", printable(name_text), address.error()));
    trackers = *address;
  }
  const Result<sim::MocapSource*> added = context.world->sensing().mocap().add(
      name_text, std::make_shared<const sim::MocapSetup>(std::move(context.arguments.mocap.setup)));
  if (!added) return context.reject(added.error());
  if (trackers) context.osc.config.trackers.push_back(std::move(*trackers));
  return context.set_id((*added)->id());
}

std::int32_t mocap_expect(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  sim::MocapSource* const source = object_of<sim::MocapSource>(context, id_of(slot, generation));
  if (source == nullptr) return kRemoved;
  if (const sim::MocapJoint* known = source->find(text_of(name, length))) return context.set_id(known->id());
  const Result<sim::MocapJoint*> added = source->expect(std::string(text_of(name, length)));
  return added ? context.set_id((*added)->id()) : context.reject(added.error());
}

std::int32_t mocap_bone(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const sim::MocapJoint* const joint = object_of<sim::MocapJoint>(context, id_of(slot, generation));
  if (joint == nullptr) return kRemoved;
  const sim::MocapSource& source = joint->source();
  context.answer.number[0] = source.bone_length(*joint);
  return context.set_id(joint->parent() < 0 ? NodeId{}
                                            : source.joints()[static_cast<std::size_t>(joint->parent())]->id());
}

}  // namespace limber::script::calls
