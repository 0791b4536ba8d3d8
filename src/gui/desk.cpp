// Images in, messages out.
#include "gui/desk.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/morph.h"

namespace limber {

namespace {

constexpr double kAskEvery = 1.0 / 20;  // s; the simulation gives a hundredth of its time to images at most
constexpr double kNoticeLasts = 2.5;    // s
constexpr double kRefusalStays = 8;     // s; a reason is read
constexpr const char* kStyle = "/visuals/look/style";
constexpr const char* kEye = "/visuals/camera/eye";
constexpr const char* kTarget = "/visuals/camera/target";

}  // namespace

std::vector<std::string> easings() {
  std::vector<std::string> names;
  for (std::string_view name : split(easing_names(), ',')) {
    if (name.starts_with(' ')) name.remove_prefix(1);
    names.emplace_back(name);
  }
  return names;
}

Message set_message(const std::string& path, const Row& row, const HandValues::Values& values) {
  Message message{path, {}};
  const bool truth = row.type == RowType::boolean || row.type == RowType::flags3;
  for (std::uint32_t i = 0; i < row.width; i++)
    message.args.push_back(truth ? Arg::of(values[i] != 0) : Arg::of(values[i]));
  return message;
}

std::uint64_t Desk::send(Message message) {
  Command command;
  command.messages.push_back(std::move(message));
  command.origin = Origin{Hand::panel, 0, gesture_, false};
  link.inbox.push(std::move(command));
  asked_ = link.ask_image();
  asked_at_ = clock;
  return asked_;
}

std::uint64_t Desk::send(std::string address, std::vector<Arg> args) {
  return send(Message{std::move(address), std::move(args)});
}

void Desk::set(const PlacedRow& at, const HandValues::Values& values, bool held) {
  if (!std::exchange(holding_, held)) gesture_++;
  if (at.path == kStyle) settings.style = at.place.row->choices[static_cast<std::size_t>(values[0])];
  hand_.set(at.path, values, send(set_message(at.path, *at.place.row, values)));
}

void Desk::set_all(const std::string& pattern, double value) {
  gesture_++;
  hand_.set(pattern, {value}, send(pattern, {Arg::of(value)}));
}

std::optional<double> Desk::shown(const std::string& pattern) const {
  const HandValues::Values* const values = hand_.find(pattern);
  return values == nullptr ? std::nullopt : std::optional((*values)[0]);
}

void Desk::step_back(const char* action, const char* what, const char* none) {
  holding_ = false;
  const std::optional<PlacedRow> at = find(what);
  const std::string_view of = at ? text(at->place) : std::string_view();
  say(of.empty() ? std::string(none) : std::string(of));
  send(action);  // whatever the image says: it may be older than what a hand has just done
}

void Desk::toggle_overlay() {
  constexpr const char* kRow = "/visuals/look/overlay";
  send(kRow, {Arg::of(number(kRow) == 0 ? 1.0 : 0.0)});
}

void Desk::undo() { step_back("/edit/undo", "/edit/undo_of", "there is nothing to undo"); }
void Desk::redo() { step_back("/edit/redo", "/edit/redo_of", "there is nothing to redo"); }

bool Desk::values(const PlacedRow& at, HandValues::Values& values) const {
  if (const HandValues::Values* const hand = hand_.find(at.path)) {
    values = *hand;
    return true;
  }
  const double* const numbers = image->value(image->tree->numbers(at.place)).numbers;
  if (numbers == nullptr) return false;
  std::copy_n(numbers, at.place.row->width, values.begin());
  return true;
}

std::string_view Desk::text(const TreePlace& place) const { return image->value(image->tree->numbers(place)).text; }

std::optional<PlacedRow> Desk::find(std::string_view path) const {
  if (image == nullptr) return std::nullopt;
  PatternBudget budget;
  const Result<std::vector<TreePlace>> places = image->tree->match(path, budget, 1);
  if (!places || places->empty() || places->front().row == nullptr) return std::nullopt;
  return PlacedRow{places->front(), std::string(path)};
}

double Desk::number(std::string_view path, double otherwise) const {
  const std::optional<PlacedRow> at = find(path);
  HandValues::Values values{};
  return at && this->values(*at, values) ? values[0] : otherwise;
}

TakeState Desk::take() const {
  TakeState take;
  if (const auto name = find("/take/name")) take.name = text(name->place);
  if (take.name.empty()) return take;
  const double timestep = number("/physics/sim/timestep");
  take.replays = number("/take/replays") != 0;
  take.plays = number("/take/plays") != 0;
  take.seconds = timestep * number("/take/ticks");
  take.whole = timestep * number("/take/whole");
  return take;
}

void Desk::choose(std::string path) {
  selected = std::move(path);
  reveal = selected;
}

void Desk::keep_view(std::size_t number) {
  const auto eye = find(kEye);
  const auto target = find(kTarget);
  View view;
  if (!eye || !target || !values(*eye, view.eye) || !values(*target, view.target)) return;
  views_.at(number - 1) = view;
  say(fmt::format("view {} is kept", number));
}

void Desk::go_to_view(std::size_t number) {
  const std::optional<View>& view = views_.at(number - 1);
  if (!view) return say(fmt::format("there is no view {0}: Ctrl+Shift+{0} keeps one", number));
  const auto point = [](const HandValues::Values& v) {
    return std::vector{Arg::of(v[0]), Arg::of(v[1]), Arg::of(v[2])};
  };
  for (const char* row : {kEye, kTarget, kEye}) send(row, point(row == kEye ? view->eye : view->target));
}

void Desk::recall(double number) {
  if (number > this->number("/preset/count")) return say(fmt::format("there is no preset {}", number));
  const std::vector<std::string> names = easings();
  const auto easing = std::min(static_cast<std::size_t>(std::max(settings.easing, 0)), names.size() - 1);
  send("/preset/recall", {Arg::of(number), Arg::of(settings.morph_seconds), Arg::of(std::string_view(names[easing]))});
}

void Desk::say(std::string text) {
  notice = std::move(text);
  notice_until = clock + kNoticeLasts;
}

void Desk::copied(const std::string& text) {
  copy(text);
  say(fmt::format("copied: {}", text));
}

// what was refused; and a rewind that went less far than it was asked to
void Desk::hear_answers() {
  link.panel_outbox.drain(answers_);
  for (const Outgoing& answer : answers_) {
    const std::vector<Arg>& args = answer.message.args;
    if (answer.to == Outgoing::To::error && args.size() == 2) {
      refusal = fmt::format("{}: {}", args[0].text, args[1].text);
      refusal_until = clock + kRefusalStays;
    } else if (answer.message.address == "/transport/rewound" && args.size() > 2) {
      say(fmt::format("{:.2f} s back, no further: {}", args[0].number, args[2].text));
    }
  }
}

// the look that was chosen in the show before; a replay is as it was
void Desk::prefer_style() {
  if (settings.style.empty()) return;
  const std::optional<PlacedRow> row = find(kStyle);
  if (!row || take().replays) return;
  const std::vector<std::string>& styles = row->place.row->choices;
  const auto found = std::ranges::find(styles, settings.style);
  if (found == styles.end()) return;
  send("/visuals/look/prefer", {Arg::of(static_cast<double>(found - styles.begin()))});
}

void Desk::look(double clock_now) {
  clock = clock_now;
  hear_answers();
  now = link.snapshots.read();
  if (std::shared_ptr<const Image> newest = link.images.read(); newest != nullptr && newest != image) {
    const bool first = image == nullptr;
    image = std::move(newest);
    hand_.heard(image->asks);
    if (first) prefer_style();
  }
  const bool waiting = image == nullptr || image->asks < asked_;
  if (asked_ == 0 || (!waiting && clock - asked_at_ >= kAskEvery)) {
    asked_ = link.ask_image();
    asked_at_ = clock;
  }
}

}  // namespace limber
