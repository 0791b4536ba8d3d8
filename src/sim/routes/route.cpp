// Route: its properties, and the steps from an input to an output: range, curve, smoothing, lag.
#include "sim/routes/route.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/hash.h"
#include "base/log/log.h"
#include "base/math/fixed_math.h"
#include "properties/path_matcher.h"
#include "properties/values_hash.h"
#include "sim/routes/route_list.h"

namespace limber::sim {

namespace {

using namespace properties;

constexpr double kMaxRange = 1e9;

enum class RouteCurve : std::uint8_t { linear, smooth, in, out };

struct RouteProperties {
  const Property *enabled, *input_low, *input_high, *output_low, *output_high, *clamp, *curve, *smoothing, *lag,
      *combine, *input, *output, *links;
};

const RouteProperties& route_properties() {
  static const auto at = [](const char* name) { return &Route::table().at(name); };
  static const RouteProperties found{
      at("enabled"),   at("input_low"), at("input_high"), at("output_low"), at("output_high"), at("clamp"), at("curve"),
      at("smoothing"), at("lag"),       at("combine"),    at("input"),      at("output"),      at("links")};
  return found;
}

// Maps 0 .. 1 to 0 .. 1. Beyond these, every curve continues as a straight line.
double curved(RouteCurve curve, double t) {
  if (t <= 0 || t >= 1) return t;
  if (curve == RouteCurve::smooth) return t * t * (3 - 2 * t);
  if (curve == RouteCurve::in) return t * t;
  return curve == RouteCurve::out ? t * (2 - t) : t;
}

}  // namespace

const PropertyTable& Route::table() {
  static const PropertyTable table(
      "route", "/physics/route/<route>", "",
      {
          boolean("enabled", true, "False: it sets nothing, and its target keeps the last value."),
          number("input_low", "", 0, -kMaxRange, kMaxRange, "Input that becomes output_low."),
          number("input_high", "", 1, -kMaxRange, kMaxRange, "Input that becomes output_high."),
          number("output_low", "", 0, -kMaxRange, kMaxRange, "Output for an input of input_low."),
          number("output_high", "", 1, -kMaxRange, kMaxRange, "Output for an input of input_high."),
          boolean("clamp", false, "True: the output stays between output_low and output_high."),
          choice("curve", {"linear", "smooth", "in", "out"}, 0,
                 "Shape of the way between both ends: straight, slow at both ends, slow at the first, slow at the "
                 "second."),
          number("smoothing", "s", 0, 0, 60, "Time constant with which the output follows; 0: at once."),
          number("lag", "s", 0, 0, 10, "Time by which the output is late; at most 4096 ticks."),
          choice("combine", {"sum", "max", "last"}, 0,
                 "How the output joins those of earlier routes to the same target: added, the larger one, or instead "
                 "of them."),
          transient(readout(number("input", "", 0, -kUnbounded, kUnbounded,
                                   "Value of its source in the last tick; of several, the first."))),
          transient(readout(number("output", "", 0, -kUnbounded, kUnbounded,
                                   "Value for its target in the last tick, before it joins those of other routes."))),
          transient(readout(integer("links", 0, 0, kUnbounded, "Number of connections; 0: it waits."))),
          text_from<&Route::read_from>(text("from", "Address or pattern of its source.")),
          text_from<&Route::read_to>(text("to", "Address or pattern of its target.")),
          text_from<&Route::read_problem>(text("problem", "Why it has no effect; empty: it works.")),
          invokes<&Route::act_remove>(action("remove", 0, 0, "Removes the route; its target keeps the last value.")),
      });
  return table;
}

Route::Route(RouteList& list, NodeId group, std::string name, std::string from, std::string to)
    : list_(list),
      id_(list.store().add(table(), group, std::move(name), this)),
      from_(std::move(from)),
      to_(std::move(to)) {}

Route::~Route() { store().remove(id_); }

Store& Route::store() const { return list_.store(); }
const std::string& Route::name() const { return store().name(id_); }

double Route::setting(const Property* property) const { return std::as_const(store()).values(id_, *property)[0]; }

RouteCombine Route::combine() const {
  return static_cast<RouteCombine>(static_cast<int>(setting(route_properties().combine)));
}

void Route::connect(std::string from, std::string to) {
  if (from == from_ && to == to_) return;
  from_ = std::move(from);
  to_ = std::move(to);
  problem_.clear();
  links_outdated_ = true;
}

bool Route::needs_links() const {
  if (links_outdated_ || links_.empty() || is_address_pattern(from_) || is_address_pattern(to_)) return true;
  const Store& nodes = store();
  return std::ranges::any_of(links_, [&](const RouteLink& link) {
    return !nodes.alive(link.from.ref.node) || !nodes.alive(link.to.ref.node);
  });
}

void Route::find_links() {
  links_outdated_ = false;
  Result<std::vector<RouteLink>> found = find_route_links(store(), from_, to_, problem_.empty());
  const std::size_t before = outputs_.size();
  links_.clear();
  if (found) {
    links_ = std::move(*found);
    problem_.clear();
  } else if (problem_.empty()) {
    set_problem(found.error());
  }
  std::size_t count = 0;
  for (const RouteLink& link : links_) count += link.from.width();
  outputs_.assign(count, 0);
  if (count != before) state_.active = false;
  publish(route_properties().links, static_cast<double>(links_.size()));
}

void Route::set_problem(std::string problem) {
  log_warning("route '{}': {}", name(), problem);
  problem_ = std::move(problem);
}

void Route::report_rejected(const std::string& why) {
  if (problem_.empty()) set_problem(why);
}

void Route::publish(const Property* property, double value) { store().transient_block(id_)[property->offset] = value; }

void Route::read_sources() {
  const Store& values = store();
  std::array<double, 4> read{};
  double* out = outputs_.data();
  for (const RouteLink& link : links_) {
    values.get(link.from.ref.node, *link.from.ref.property, read.data());
    if (link.from.component == RouteEnd::kLength) {
      *out++ = std::sqrt(read[0] * read[0] + read[1] * read[1] + read[2] * read[2]);
    } else if (link.from.component != RouteEnd::kAll) {
      *out++ = read[static_cast<std::size_t>(link.from.component)];
    } else {
      out = std::copy_n(read.data(), link.from.width(), out);
    }
  }
}

void Route::map_outputs() {
  const RouteProperties& p = route_properties();
  const double input_low = setting(p.input_low);
  const double range = setting(p.input_high) - input_low;
  const double low = setting(p.output_low);
  const double high = setting(p.output_high);
  const bool clamp = setting(p.clamp) != 0;
  const auto curve = static_cast<RouteCurve>(static_cast<int>(setting(p.curve)));
  const bool copies = input_low == 0 && range == 1 && low == 0 && high == 1 && !clamp && curve == RouteCurve::linear;
  if (copies) return;
  for (double& value : outputs_) {
    // an empty range is a threshold
    double t = range != 0 ? (value - input_low) / range : value >= input_low ? 1 : 0;
    if (clamp) t = std::clamp(t, 0.0, 1.0);
    t = curved(curve, t);
    value = t == 1 ? high : low + t * (high - low);
  }
}

void Route::smooth(double dt) {
  const double seconds = setting(route_properties().smoothing);
  if (!state_.active || seconds <= 0) {
    state_.smoothed = outputs_;
    return;
  }
  const double share = 1 - fixed::exp(-dt / seconds);
  for (std::size_t i = 0; i < outputs_.size(); i++) {
    state_.smoothed[i] += share * (outputs_[i] - state_.smoothed[i]);
    outputs_[i] = state_.smoothed[i];
  }
}

void Route::delay(double dt) {
  const std::size_t width = outputs_.size();
  const double most = std::min(static_cast<double>(kMaxLagTicks),
                               std::floor(static_cast<double>(kMaxLagNumbers) / static_cast<double>(width)));
  const auto lag = static_cast<std::uint32_t>(std::min(std::round(setting(route_properties().lag) / dt), most));
  if (lag != state_.lag || !state_.active) {
    state_.lag = lag;
    state_.next = 0;
    state_.delayed.clear();
    for (std::uint32_t i = 0; i < lag; i++)
      state_.delayed.insert(state_.delayed.end(), outputs_.begin(), outputs_.end());
  }
  if (lag == 0) return;
  double* const oldest = state_.delayed.data() + std::size_t{state_.next} * width;
  std::swap_ranges(oldest, oldest + width, outputs_.data());
  state_.next = (state_.next + 1) % lag;
}

void Route::compute(double dt) {
  const RouteProperties& p = route_properties();
  if (links_.empty() || setting(p.enabled) == 0) {
    state_.active = false;
    return;
  }
  read_sources();
  publish(p.input, outputs_.front());
  map_outputs();
  smooth(dt);
  delay(dt);
  publish(p.output, outputs_.front());
  state_.active = true;
}

std::span<const double> Route::outputs() const {
  return state_.active ? std::span<const double>(outputs_) : std::span<const double>();
}

void Route::serialize(Archive& archive) {
  archive.serialize_all(state_.active, state_.lag, state_.next, state_.smoothed, state_.delayed);
}

std::uint64_t Route::state_hash(std::uint64_t start) const {
  NumberHash numbers(hash_bytes(to_, hash_bytes(from_, hash_bytes(name(), start))));
  numbers.add_word(node_hash(store(), id_));
  if (state_.active) {
    numbers.add(state_.smoothed);
    numbers.add_word(state_.next);
    numbers.add(state_.delayed);
  }
  return numbers.value();
}

Result<void> Route::act_remove(std::span<const double>) {
  list_.remove(*this);
  return {};
}

}  // namespace limber::sim
