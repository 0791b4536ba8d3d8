// Bindings: the batch of messages.
#include "net/midi/bindings.h"

#include <algorithm>
#include <utility>

namespace limber::midi {

namespace {

bool same_args(const std::vector<Arg>& a, const std::vector<Arg>& b) {
  return std::ranges::equal(
      a, b, [](const Arg& x, const Arg& y) { return x.kind == y.kind && x.number == y.number && x.text == y.text; });
}

bool same_entry(const MidiEntry& a, const MidiEntry& b) {
  return a.port == b.port && a.channel == b.channel && a.kind == b.kind && a.number == b.number &&
         a.address == b.address && a.component == b.component && a.range == b.range && a.mode == b.mode &&
         a.step == b.step && a.pickup == b.pickup && a.feedback == b.feedback && same_args(a.values, b.values);
}

}  // namespace

void Bindings::set_map(const MidiMap& map) {
  std::vector<Binding> before = std::exchange(bindings_, {});
  batch_.clear();
  sent_.clear();
  for (const MidiEntry& entry : map) {
    const auto same = std::ranges::find_if(before, [&](const Binding& old) { return same_entry(old.entry(), entry); });
    bindings_.push_back(same != before.end() ? *same : Binding(entry));
    if (snapshot_ != nullptr) bindings_.back().update(*snapshot_);
  }
}

void Bindings::update(const std::shared_ptr<const engine::ValueSnapshot>& snapshot) {
  if (snapshot == nullptr || snapshot == snapshot_) return;
  snapshot_ = snapshot;
  for (Binding& binding : bindings_) binding.update(*snapshot);
}

bool Bindings::accept(std::string_view port, const ControlEvent& event, std::int64_t now) {
  bool any = false;
  for (std::size_t i = 0; i < bindings_.size(); i++) {
    if (!matches(bindings_[i].entry(), port, event)) continue;
    any = true;
    if (std::optional<Message> message = bindings_[i].accept(event, now)) add(i, std::move(*message));
  }
  return any;
}

void Bindings::release(std::string_view port, std::int64_t now) {
  for (std::size_t i = 0; i < bindings_.size(); i++) {
    const MidiEntry& entry = bindings_[i].entry();
    if (!bindings_[i].is_pressed() || !port_matches(port, entry.port)) continue;
    const ControlEvent released{entry.kind, bindings_[i].last_channel(), entry.number, 0};
    if (std::optional<Message> message = bindings_[i].accept(released, now)) add(i, std::move(*message));
  }
}

// Sets the numbers of a vector that other controls have sent, and no snapshot contains yet.
void Bindings::merge_components(std::size_t index, Message& message) const {
  const Binding& binding = bindings_[index];
  if (binding.entry().component == 0 || message.args.size() < 2) return;
  for (const Binding& other : bindings_) {
    const bool same = &other != &binding && other.entry().component > 0 && other.has_pending_value() &&
                      other.property().path == binding.property().path;
    if (same && other.property().component != binding.property().component)
      message.args[other.property().component] = Arg::of(*other.present());
  }
}

void Bindings::add(std::size_t index, Message message) {
  merge_components(index, message);
  const ControlMode mode = bindings_[index].mode();
  const bool is_press = mode != ControlMode::absolute && !is_relative(mode);
  const auto same = std::ranges::find_if(
      batch_, [&](const Pending& pending) { return pending.binding == index && !pending.is_press; });
  if (same != batch_.end()) batch_.erase(same);  // the new message is last, as it arrived
  const auto presses = static_cast<std::size_t>(std::ranges::count_if(batch_, &Pending::is_press));
  if (!is_press || presses < kMaxPresses) batch_.push_back({index, is_press, std::move(message)});
}

std::vector<Message> Bindings::drain() {
  std::vector<Message> messages;
  sent_.clear();
  for (Pending& pending : batch_) {
    sent_.push_back(pending.binding);
    messages.push_back(std::move(pending.message));
  }
  batch_.clear();
  return messages;
}

void Bindings::note_sent(std::uint64_t request) {
  for (const std::size_t index : sent_) bindings_[index].note_sent(request);
  sent_.clear();
}

}  // namespace limber::midi
