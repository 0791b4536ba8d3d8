// Actions, runs and images of the variations.
#include "app/breed/breed_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/system/clock.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::app {

static_assert(BreedSession::kCount == panel::BreedView::kCells);

namespace {

using experiments::Axis;
using Kind = panel::BreedAction::Kind;

// A value for people: a word, or a number with four digits.
std::string short_text(const Axis& axis, double value) {
  if (axis.boolean) return value != 0 ? "true" : "false";
  return axis.choices.empty() ? fmt::format("{:.4g}", value) : axis.text(value);
}

void add(MouseMovement& sum, const MouseMovement& more) {
  sum.orbit_x += more.orbit_x;
  sum.orbit_y += more.orbit_y;
  sum.pan_x += more.pan_x;
  sum.pan_y += more.pan_y;
  sum.wheel += more.wheel;
}

}  // namespace

BreedSession::BreedSession(Options options, experiments::Breeding breeding)
    : options_(std::move(options)), breeding_(std::move(breeding)) {
  for (std::size_t i = 0; i < kCount; i++) processes_.emplace_back(options_.command, options_.setup);
  for (const Axis& axis : breeding_.axes()) view_.parameters.push_back({axis.name, false});
  play_all();
}

// Starts all variations at the same time, so that they can be compared.
void BreedSession::play_all() {
  runs_++;
  for (std::size_t i = 0; i < kCount; i++) processes_[i].play({runs_, options_.seed, breeding_.values(i)});
}

bool BreedSession::operate(const panel::BreedAction& action) {
  switch (action.kind) {
    case Kind::mutate:
      return breeding_.mutate(action.amount);
    case Kind::cross:
      return breeding_.cross();
    default:
      return breeding_.randomize();
  }
}

void BreedSession::perform(const panel::BreedAction& action) {
  switch (action.kind) {
    case Kind::like:
      return breeding_.toggle_liked(action.index);
    case Kind::hold:
      return breeding_.toggle_held(action.index);
    case Kind::keep:
      return keep(action.name);
    case Kind::pause:
      view_.paused = !view_.paused;
      return;
    case Kind::follow:
      view_.following = !view_.following;
      return;
    case Kind::undo:
      breeding_.undo();
      break;
    case Kind::redo:
      breeding_.redo();
      break;
    case Kind::mutate:
    case Kind::cross:
    case Kind::randomize:
      if (!operate(action)) return notify("All are liked, so none can change. Like fewer.", true);
      break;
    case Kind::restart:
      break;
    case Kind::full_screen:
      return;
  }
  notify({}, false);
  play_all();
}

// Returns the latest one, or of those of that name; nullptr: there is none.
const BreedSession::Kept* BreedSession::find_kept(const experiments::Breeding::Vector& individual,
                                                  const std::string* name) const {
  const auto found = std::ranges::find_if(kept_, [&](const Kept& each) {
    return each.individual == individual && (name == nullptr || each.name == *name);
  });
  return found == kept_.end() ? nullptr : &*found;
}

void BreedSession::keep(const std::string& name) {
  if (std::ranges::none_of(breeding_.current().liked, [](bool liked) { return liked; }))
    return notify("None is liked. Click those to keep.", true);
  std::vector<std::size_t> liked;
  std::vector<std::vector<double>> values;
  for (std::size_t i = 0; i < kCount; i++) {
    if (!breeding_.current().liked[i]) continue;
    if (const Kept* const before = find_kept(breeding_.current().individuals[i], &name); before != nullptr) {
      notify(fmt::format("{} is kept already", before->preset), false);
      continue;
    }
    liked.push_back(i);
    values.push_back(breeding_.values(i));
  }
  if (liked.empty()) return;
  std::string notice;
  const Result<std::vector<std::string>> names = options_.presets.add(breeding_.axes(), values, name, notice);
  if (!names) return notify(names.error(), true);
  for (std::size_t i = 0; i < liked.size(); i++)
    kept_.insert(kept_.begin(), {breeding_.current().individuals[liked[i]], name, (*names)[i]});
  notify(fmt::format("Kept {} in {}{}{}", fmt::join(*names, ", "), printable(options_.presets.file),
                     notice.empty() ? "" : ". ", notice),
         false);
}

void BreedSession::notify(std::string text, bool failed) {
  view_.notice = std::move(text);
  view_.failed = failed;
}

void BreedSession::request_images(int width, int height, const MouseMovement& mouse, double now) {
  add(mouse_, mouse);
  const ImageRequest request{std::clamp(width, 1, kMaxVariationSize), std::clamp(height, 1, kMaxVariationSize),
                             view_.paused, view_.following, mouse_};
  for (VariationProcess& process : processes_) {
    process.check(now);
    process.request(request, now);
  }
}

std::array<bool, BreedSession::kCount> BreedSession::read_images(double seconds) {
  std::array<bool, kCount> changed{};
  const double end = system::clock_seconds() + seconds;
  std::array<system::PollEntry, kCount> entries;
  for (double left = seconds; left > 0; left = end - system::clock_seconds()) {
    for (std::size_t i = 0; i < kCount; i++) entries[i] = {processes_[i].descriptor()};
    if (!system::wait_ready(entries, std::chrono::nanoseconds(std::llround(left * 1e9)))) continue;
    for (std::size_t i = 0; i < kCount; i++) {
      if (entries[i].ready && processes_[i].read()) changed[i] = true;
    }
  }
  return changed;
}

const panel::BreedView& BreedSession::view() {
  const experiments::Breeding::Generation& now = breeding_.current();
  for (std::size_t i = 0; i < kCount; i++) {
    panel::BreedCell& cell = view_.cells[i];
    cell.liked = now.liked[i];
    cell.kept = now.kept[i];
    cell.error = processes_[i].error();
    cell.positions = now.individuals[i];
    cell.values.clear();
    const std::vector<double> values = breeding_.values(i);
    for (std::size_t k = 0; k < values.size(); k++) cell.values.push_back(short_text(breeding_.axes()[k], values[k]));
    const Kept* const kept = find_kept(now.individuals[i]);
    cell.preset = kept == nullptr ? "" : kept->preset;
  }
  for (std::size_t k = 0; k < view_.parameters.size(); k++) view_.parameters[k].held = breeding_.held(k);
  view_.generation = now.number;
  view_.can_undo = breeding_.can_undo();
  view_.can_redo = breeding_.can_redo();
  return view_;
}

}  // namespace limber::app
