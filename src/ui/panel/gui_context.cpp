// Reads snapshots and sends messages.
#include "ui/panel/gui_context.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/presets/morph.h"

namespace limber::panel {

namespace {

constexpr double kNoticeDuration = 2.5;   // s
constexpr double kRejectionDuration = 8;  // s; long enough to read the reason
constexpr const char* kStyle = "/visuals/look/style";

// Returns the message that sets a property to these values.
Message set_message(const std::string& path, const Property& property, const PendingValues::Values& values) {
  Message message{path, {}};
  const bool is_boolean = property.type == PropertyType::boolean || property.type == PropertyType::flags3;
  for (std::uint32_t i = 0; i < property.width; i++)
    message.args.push_back(is_boolean ? Arg::of(values[i] != 0) : Arg::of(values[i]));
  return message;
}

}  // namespace

std::uint64_t GuiContext::send(Message message) { return commands_.send(std::move(message), clock); }

std::uint64_t GuiContext::send(std::string address, std::vector<Arg> args) {
  return send(Message{std::move(address), std::move(args)});
}

void GuiContext::set(const PropertyHandle& handle, const PendingValues::Values& values, bool dragging) {
  commands_.begin_edit(dragging);
  if (handle.path == kStyle) settings.style = handle.ref.property->choices[static_cast<std::size_t>(values[0])];
  pending_.set(handle.path, values, send(set_message(handle.path, *handle.ref.property, values)));
}

void GuiContext::set_all(const std::string& pattern, double value) {
  commands_.begin_edit();
  pending_.set(pattern, {value}, send(pattern, {Arg::of(value)}));
}

std::optional<double> GuiContext::pending_value(const std::string& pattern) const {
  const PendingValues::Values* const values = pending_.find(pattern);
  return values == nullptr ? std::nullopt : std::optional((*values)[0]);
}

void GuiContext::undo_or_redo(const char* action, const char* description_path, const char* nothing_text) {
  commands_.end_drag();
  const std::optional<PropertyHandle> handle = find(description_path);
  const std::string_view description = handle ? text(handle->ref) : std::string_view();
  show_notice(description.empty() ? std::string(nothing_text) : std::string(description));
  send(action);  // even if the snapshot has nothing to undo: it may be older than the last edit
}

void GuiContext::toggle(const char* path) { send(path, {Arg::of(number(path) == 0 ? 1.0 : 0.0)}); }

void GuiContext::undo() { undo_or_redo("/edit/undo", "/edit/undo_of", "Nothing to undo"); }
void GuiContext::redo() { undo_or_redo("/edit/redo", "/edit/redo_of", "Nothing to redo"); }

bool GuiContext::values(const PropertyHandle& handle, PendingValues::Values& values) const {
  if (const PendingValues::Values* const pending = pending_.find(handle.path)) {
    values = *pending;
    return true;
  }
  const double* const numbers = value_snapshot->value(value_snapshot->tree->location(handle.ref)).numbers;
  if (numbers == nullptr) return false;
  std::copy_n(numbers, handle.ref.property->width, values.begin());
  return true;
}

std::string_view GuiContext::text(const TreePropertyRef& ref) const {
  return value_snapshot->value(value_snapshot->tree->location(ref)).text;
}

std::optional<PropertyHandle> GuiContext::find(std::string_view path) const {
  if (value_snapshot == nullptr) return std::nullopt;
  PatternBudget budget;
  const Result<std::vector<TreePropertyRef>> matches = value_snapshot->tree->match(path, budget, 1);
  if (!matches || matches->empty() || matches->front().property == nullptr) return std::nullopt;
  return PropertyHandle{matches->front(), std::string(path)};
}

double GuiContext::number(std::string_view path, double fallback) const {
  const std::optional<PropertyHandle> handle = find(path);
  PendingValues::Values values{};
  return handle && this->values(*handle, values) ? values[0] : fallback;
}

TakeState GuiContext::take_state() const {
  TakeState state;
  if (const auto name = find("/take/name")) state.name = text(name->ref);
  if (state.name.empty()) return state;
  const double timestep = number("/physics/sim/timestep");
  state.replaying = number("/take/replays") != 0;
  state.in_show = number("/take/plays") != 0;
  state.seconds = timestep * number("/take/ticks");
  state.duration = timestep * number("/take/whole");
  return state;
}

void GuiContext::toggle_take_playback() {
  if (take_state().in_show) {
    send("/take/stop");
    return;
  }
  requests.confirmation = {"Play the latest take? It replaces the running show until it ends or is stopped.",
                           "Play take",
                           {"/take/play", {}}};
}

void GuiContext::select(std::string path) {
  selected = std::move(path);
  requests.reveal_path = selected;
}

void GuiContext::recall(double number) {
  if (number > this->number("/preset/count")) return show_notice(fmt::format("Preset {} not found", number));
  const std::vector<std::string> names = engine::easings();
  const auto easing = std::min(static_cast<std::size_t>(std::max(settings.easing, 0)), names.size() - 1);
  send("/preset/recall", {Arg::of(number), Arg::of(settings.morph_seconds), Arg::of(std::string_view(names[easing]))});
}

void GuiContext::show_notice(std::string text) { notice = {std::move(text), clock + kNoticeDuration}; }

void GuiContext::copy_with_notice(const std::string& text) {
  copy(text);
  show_notice(fmt::format("Copied: {}", text));
}

// Handles replies: rejected messages, and rewinds that went back less than requested.
void GuiContext::handle_replies() {
  for (const engine::Outgoing& reply : commands_.replies()) {
    const std::vector<Arg>& args = reply.message.args;
    if (reply.destination == engine::Outgoing::Destination::error && args.size() == 2) {
      rejection = {fmt::format("{}: {}", args[0].text, args[1].text), clock + kRejectionDuration};
    } else if (reply.message.address == "/transport/added" && !args.empty()) {
      show_notice(fmt::format("{} was added to the scene", args[0].text));
    } else if (reply.message.address == "/midi/learned" && args.size() == 2) {
      show_notice(fmt::format("{} sets {}", args[1].text, args[0].text));
    } else if (reply.message.address == "/transport/rewound" && args.size() > 2) {
      show_notice(fmt::format("Rewound only {:.2f} s: {}", args[0].number, args[2].text));
    }
  }
}

// Restores the style selected in the last session, except in a replay.
void GuiContext::restore_style() {
  if (settings.style.empty()) return;
  const std::optional<PropertyHandle> style = find(kStyle);
  if (!style || take_state().replaying) return;
  const std::vector<std::string>& styles = style->ref.property->choices;
  const auto found = std::ranges::find(styles, settings.style);
  if (found == styles.end()) return;
  send("/visuals/look/prefer", {Arg::of(static_cast<double>(found - styles.begin()))});
}

void GuiContext::begin_frame(double clock_now) {
  clock = clock_now;
  handle_replies();
  snapshot = link.snapshots.read();
  if (std::shared_ptr<const engine::ValueSnapshot> newest = link.value_snapshots.read();
      newest != nullptr && newest != value_snapshot) {
    const bool first = value_snapshot == nullptr;
    value_snapshot = std::move(newest);
    pending_.remove_confirmed(value_snapshot->request);
    if (first) restore_style();
  }
  commands_.update_request(value_snapshot.get(), clock);
}

}  // namespace limber::panel
