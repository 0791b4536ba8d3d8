// Mapping: requests to learn and forget, and the texts of the report.
#include "net/midi/mapping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "base/text.h"

namespace limber::midi {

namespace {

// a range that is larger by this factor than a typical value is too wide for a control
constexpr double kWideRange = 1000;

// Parses the arguments of /midi/learn.
Result<LearnRequest> learn_request(const std::vector<Arg>& args) {
  LearnRequest request;
  request.address = args[0].text;
  for (const Arg& arg : std::vector<Arg>(args.begin() + 1, args.end())) {
    if (arg.is_text()) {
      request.mode = control_mode_of(arg.text);
      if (!request.mode)
        return Error{fmt::format("unknown mode '{}'; expected one of: {}", printable(shortened(arg.text, 100)),
                                 fmt::join(kControlModeNames, ", "))};
    } else if (arg.number >= 1 && arg.number <= 4 && arg.number == std::floor(arg.number)) {
      request.component = static_cast<int>(arg.number);
    } else {
      return Error{fmt::format("the component must be 1 to 4, got {}", number_text(arg.number))};
    }
  }
  return request;
}

// Why no control can set the address; empty: one can.
std::string learn_fault(const LearnRequest& request, const engine::ValueSnapshot* snapshot) {
  if (!request.address.starts_with('/') || request.address.size() > MidiEntry::kMaxText ||
      printable(request.address) != request.address)
    return fmt::format("'{}' is not an address; it must begin with /", printable(shortened(request.address, 100)));
  if (normalized_name(request.address).starts_with("/midi/"))
    return "a control can't learn or forget other controls; name another address";
  if (snapshot == nullptr) return {};
  MidiEntry probe;
  probe.address = request.address;
  probe.component = request.component;
  probe.range = {0, 1};  // without a limit, learning chooses a range
  return bind(probe, *snapshot->tree).problem;
}

std::string state_text(const Binding& binding) {
  if (!binding.ready()) return "";
  if (!binding.property().problem.empty()) return binding.property().problem;
  if (binding.awaits_pickup()) {
    const std::optional<double> value = binding.present();
    if (value) return fmt::format("move it past {:.4g}", *value);
  }
  return std::string(control_mode_name(binding.mode()));
}

}  // namespace

void Mapping::open(const std::string& scene) {
  file_.open(MapFile::path_for(scene));
  file_error_.clear();
  learner_.cancel();
  use({});
}

void Mapping::use(MidiMap map) {
  map_ = std::move(map);
  bindings_.set_map(map_);
  feedback_.reset();
}

void Mapping::poll_file(std::int64_t now) {
  std::optional<Result<MidiMap>> read = file_.poll(now);
  if (!read) return;
  file_error_ = *read ? "" : read->error();
  if (!*read) return log_error("{}; the map that was loaded before stays", file_error_);
  use(std::move(**read));
  log_info("{}: {} loaded", printable(file_.path()), counted(map_.size(), "MIDI control"));
}

Result<std::string> Mapping::learn(const std::vector<Arg>& args) {
  if (args.empty() || (args.size() == 1 && args[0].is_text() && args[0].text.empty())) {
    learner_.cancel();
    return std::string();
  }
  Result<LearnRequest> request = learn_request(args);
  if (!request) return Error{request.error()};
  const std::string fault = learn_fault(*request, snapshot_.get());
  if (!fault.empty()) return Error{fault};
  std::string address = request->address;
  learner_.begin(std::move(*request));
  return address;
}

Result<std::string> Mapping::forget(const std::vector<Arg>& args) {
  const std::string& address = args[0].text;
  MidiMap map = map_;
  const auto is_of = [&](const MidiEntry& entry) {
    return entry.address == address && (args.size() < 2 || entry.component == args[1].number);
  };
  const std::size_t removed = std::erase_if(map, is_of);
  if (removed == 0) {
    std::vector<std::string_view> known;
    for (const MidiEntry& entry : map_) known.push_back(entry.address);
    return Error{fmt::format("no control sets {}{}", printable(shortened(address, 100)), name_hint(address, known))};
  }
  if (!file_error_.empty()) return Error{fmt::format("{}. Correct the file first", file_error_)};
  use(std::move(map));
  if (const Result<void> saved = file_.save(map_); !saved) return Error{saved.error()};
  return address;
}

std::optional<Result<std::string>> Mapping::finish_learning(std::int64_t now) {
  std::optional<MidiEntry> entry = learner_.finish(now);
  if (!entry) return std::nullopt;
  choose_range(*entry);
  std::string control = control_text(*entry);
  if (const Result<void> added = add(std::move(*entry)); !added) return Result<std::string>(Error{added.error()});
  return Result<std::string>(std::move(control));
}

// Adds an entry, which replaces those of the same address.
Result<void> Mapping::add(MidiEntry entry) {
  if (!file_error_.empty()) return Error{fmt::format("{}. Correct the file, then learn again", file_error_)};
  MidiMap map = map_;
  std::erase_if(map, [&](const MidiEntry& other) {
    return other.address == entry.address && other.component == entry.component;
  });
  if (map.size() >= kMaxEntries) return Error{fmt::format("at most {} entries", kMaxEntries)};
  map.push_back(std::move(entry));
  use(std::move(map));
  return file_.save(map_);
}

// A range around the present value, if the property's has no limits or is far too wide.
void Mapping::choose_range(MidiEntry& entry) const {
  if (snapshot_ == nullptr) return;
  const BoundProperty bound = bind(entry, *snapshot_->tree);
  if (bound.property == nullptr || bound.is_action() || bound.is_whole()) return;
  const engine::PropertyValue value = snapshot_->value(bound.location);
  if (value.numbers == nullptr) return;
  const Property& property = *bound.property;
  const double now = value.numbers[bound.component];
  const double span = std::max({std::abs(now), std::abs(property.initial[bound.component]), 1.0});
  const double low = property.low(bound.component);
  const double high = property.high(bound.component);
  if (high - low <= kWideRange * span) return;
  entry.range = {std::max(low, now - span), std::min(high, now + span)};
}

void Mapping::update(const std::shared_ptr<const engine::ValueSnapshot>& snapshot) {
  if (snapshot == nullptr) return;
  snapshot_ = snapshot;
  bindings_.update(snapshot);
}

void Mapping::accept(std::string_view port, const ControlEvent& event, std::int64_t now) {
  if (learner_.request()) return learner_.accept(port, event, now);  // it doesn't act at the same time
  bindings_.accept(port, event, now);
  feedback_.note_movement(bindings_, port, event);
}

void Mapping::report(engine::MidiReport& report) const {
  report.file = file_.path();
  report.file_error = file_error_;
  if (learner_.request()) report.learning = learner_.request()->address;
  for (const Binding& binding : bindings_.list()) {
    const MidiEntry& entry = binding.entry();
    std::string address = entry.address;
    if (entry.component > 0) address += fmt::format(" [{}]", entry.component);
    report.entries.push_back(
        {control_text(entry), std::move(address), state_text(binding), !binding.property().problem.empty()});
  }
}

}  // namespace limber::midi
