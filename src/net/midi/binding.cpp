// Binding: ranges, modes and soft takeover.
#include "net/midi/binding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::midi {

namespace {

constexpr double kEncoderSteps = 127;  // steps of an encoder from one end of the range to the other

std::string unusable(const Property& property, const std::string& path) {
  if (property.kind == PropertyKind::readout) return fmt::format("{} is read-only; name a setting", path);
  if (property.type == PropertyType::text) return fmt::format("{} is a text; name a number", path);
  return {};
}

// Returns the signed steps of an encoder.
int steps_of(ControlMode mode, int value) {
  if (mode == ControlMode::relative_offset) return value - 64;
  if (mode == ControlMode::relative_sign) return (value & 64) != 0 ? -(value & 63) : value & 63;
  return value < 64 ? value : value - 128;
}

// Why a button can't trigger the property.
std::string trigger_fault(const MidiEntry& entry, const BoundProperty& bound) {
  const std::uint32_t required = bound.is_action() ? bound.property->min_args : bound.property->width;
  if (entry.mode != ControlMode::trigger || entry.values.size() >= required) return {};
  return fmt::format("{} needs a value; give the entry its \"values\", such as [1]", bound.path);
}

// Sets the range of the entry, or the property's.
void bind_range(const MidiEntry& entry, BoundProperty& bound) {
  const Property* const property = bound.property;
  if (entry.range) {
    bound.low = (*entry.range)[0];
    bound.high = (*entry.range)[1];
  } else if (property != nullptr && !bound.is_action() && !bound.is_boolean()) {
    bound.low = property->low(bound.component);
    bound.high = property->high(bound.component);
    const bool relative = entry.mode && is_relative(*entry.mode);
    if (relative && entry.step) return;
    if (!std::isfinite(bound.low) || !std::isfinite(bound.high))
      bound.problem = fmt::format("{} has no limits; give the entry a range, such as \"range\": [0, 1]", bound.path);
  }
}

}  // namespace

bool BoundProperty::is_whole() const {
  return property != nullptr && (property->type == PropertyType::integer || property->type == PropertyType::boolean ||
                                 property->type == PropertyType::choice || property->type == PropertyType::flags3);
}

BoundProperty bind(const MidiEntry& entry, const TreeSnapshot& tree) {
  BoundProperty bound;
  bound.path = entry.address;
  PatternBudget budget{PatternBudget::kStepsPerMessage};
  const Result<std::vector<TreePropertyRef>> found = tree.match(entry.address, budget, kMaxEntries);
  const auto usable = [](const TreePropertyRef& ref) { return ref.property != nullptr; };
  const bool known = found && std::ranges::any_of(*found, usable);
  if (!known) return bind_range(entry, bound), bound;
  const auto settable = [](const TreePropertyRef& ref) {
    return ref.property != nullptr && unusable(*ref.property, "").empty();
  };
  auto ref = std::ranges::find_if(*found, settable);
  if (ref == found->end()) ref = std::ranges::find_if(*found, usable);
  const Property& property = *ref->property;
  bound.path = tree.path(*ref);
  bound.problem = unusable(property, bound.path);
  if (!bound.problem.empty()) return bound;
  bound.property = &property;
  bound.problem = trigger_fault(entry, bound);
  if (bound.is_action() || !bound.problem.empty()) return bind_range(entry, bound), bound;
  bound.location = tree.location(*ref);
  const auto width = static_cast<int>(property.width);
  if (entry.component > width || (entry.component == 0 && width > 1)) {
    bound.problem =
        fmt::format("{} has {} numbers; set \"component\" to a number from 1 to {}", bound.path, width, width);
    return bound;
  }
  bound.component = static_cast<std::size_t>(std::max(entry.component, 1) - 1);
  bind_range(entry, bound);
  return bound;
}

ControlMode default_mode(const MidiEntry& entry, const BoundProperty& property) {
  const bool button = entry.kind == ControlKind::note || entry.kind == ControlKind::program;
  if (property.is_action() && property.property->min_args == 0) return ControlMode::trigger;
  if (property.is_boolean()) return ControlMode::toggle;
  return button && property.property == nullptr ? ControlMode::trigger : ControlMode::absolute;
}

void Binding::update(const engine::ValueSnapshot& snapshot) {
  if (tree_ != snapshot.tree) {
    tree_ = snapshot.tree;
    property_ = bind(entry_, *tree_);
  }
  snapshot_request_ = snapshot.request;
  snapshot_value_.reset();
  if (property_.property == nullptr || property_.is_action()) return;
  const engine::PropertyValue value = snapshot.value(property_.location);
  if (value.numbers == nullptr) return;
  std::copy_n(value.numbers, std::min<std::size_t>(property_.property->width, components_.size()), components_.begin());
  snapshot_value_ = components_[property_.component];
}

std::optional<double> Binding::present() const { return has_pending_value() ? sent_ : snapshot_value_; }

std::optional<int> Binding::control_value() const {
  const std::optional<double> value = present();
  if (!ready() || !value || !property_.problem.empty()) return std::nullopt;
  const double position = position_of(*value);
  const bool on_off = mode() == ControlMode::toggle || mode() == ControlMode::momentary;
  return static_cast<int>(std::lround((on_off ? std::round(position) : position) * max_value(entry_.kind)));
}

double Binding::position_of(double value) const {
  return std::clamp((value - property_.low) / (property_.high - property_.low), 0.0, 1.0);
}

std::optional<Message> Binding::accept(const ControlEvent& event, std::int64_t now) {
  if (!ready() || !property_.problem.empty()) return std::nullopt;
  last_channel_ = event.channel;
  moved_at_ = now;
  const ControlMode mode = this->mode();
  if (is_relative(mode)) return relative(steps_of(mode, event.value));
  std::optional<Message> message;
  if (mode == ControlMode::absolute) {
    message = absolute(event.position());
  } else {
    const bool is_key = event.kind == ControlKind::note;
    message = press(is_key ? event.value > 0 : 2 * event.value > max_value(event.kind));
    if (event.kind == ControlKind::program) pressed_ = false;
  }
  control_ = event.position();
  return message;
}

// True if the control is at the present value, or has passed it.
bool Binding::picks_up(double position) const {
  const std::optional<double> value = present();
  if (!entry_.pickup || !value || property_.is_boolean()) return true;
  const double at = position_of(*value);
  if (std::abs(position - at) <= kPickupDistance) return true;
  const bool holds = sent_ && !awaits_pickup_ && std::abs(position_of(*sent_) - at) <= kPickupDistance;
  return holds || (control_ && (*control_ - at) * (position - at) <= 0);
}

std::optional<Message> Binding::absolute(double position) {
  const bool is_key = entry_.kind == ControlKind::note;
  awaits_pickup_ = !is_key && !picks_up(position);
  if (awaits_pickup_) return std::nullopt;
  return send_value(property_.low + (property_.high - property_.low) * position);
}

std::optional<Message> Binding::relative(int steps) {
  const std::optional<double> value = present();
  if (!value || steps == 0) return std::nullopt;
  const double range = property_.high - property_.low;
  const double step = entry_.step.value_or(property_.is_whole() ? std::copysign(1.0, range) : range / kEncoderSteps);
  const double moved = *value + steps * step;
  if (!std::isfinite(moved)) return std::nullopt;
  const auto [low, high] = std::minmax(property_.low, property_.high);
  return send_value(std::clamp(moved, low, high));
}

std::optional<Message> Binding::press(bool pressed) {
  const bool changed = std::exchange(pressed_, pressed) != pressed;
  if (!changed) return std::nullopt;
  const ControlMode mode = this->mode();
  if (mode == ControlMode::momentary) return send_value(pressed ? property_.high : property_.low);
  if (!pressed) return std::nullopt;
  if (mode == ControlMode::trigger) return Message{entry_.address, entry_.values};
  const std::optional<double> value = present();
  flipped_ = value ? position_of(*value) < 0.5 : !flipped_;
  return send_value(flipped_ ? property_.high : property_.low);
}

// Returns the message that sets the value; nothing if it is set already.
std::optional<Message> Binding::send_value(double value) {
  if (property_.is_whole()) value = std::round(value);
  const std::optional<double> before = present();
  sent_ = value;
  if (before == value) return std::nullopt;
  sent_request_ = std::numeric_limits<std::uint64_t>::max();  // until note_sent()
  Message message{entry_.address, {}};
  if (property_.property == nullptr || entry_.component == 0) {
    message.args.push_back(property_.is_boolean() ? Arg::of(value >= 0.5) : Arg::of(value));
    return message;
  }
  components_[property_.component] = value;
  for (std::size_t i = 0; i < property_.property->width; i++) message.args.push_back(Arg::of(components_[i]));
  return message;
}

}  // namespace limber::midi
