// Hands costs to the module, records them, and runs the algorithm again on restore().
#include "experiments/module_search.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kDigits = 16;  // of a cost
constexpr std::uint64_t kHashStart = 1;

// Returns nullopt if the text isn't a list of costs.
std::optional<std::vector<double>> parse_costs(std::string_view text) {
  if (text.size() % kDigits != 0) return {};
  std::vector<double> costs;
  costs.reserve(text.size() / kDigits);
  for (const char* at = text.data(); at != text.data() + text.size(); at += kDigits) {
    std::uint64_t bits = 0;
    const auto [end, error] = std::from_chars(at, at + kDigits, bits, 16);
    costs.push_back(std::bit_cast<double>(bits));
    if (end != at + kDigits || error != std::errc() || !(std::abs(costs.back()) <= ModuleSearch::kMaxCost)) return {};
  }
  return costs;
}

}  // namespace

ModuleSearch::ModuleSearch(const Options& options)
    : options_(options),
      search_(nullptr, options.module == nullptr ? nullptr : options.module->destroy),
      asked_(kHashStart),
      elites_(options.axes, options.objectives) {
  if (options_.population == 0) options_.population = kPopulation;
  start();
}

void ModuleSearch::start() {
  if (options_.module == nullptr) return;
  // pagmo's seeds have 32 bits
  const auto seed = static_cast<std::uint32_t>(options_.seed ^ (options_.seed >> 32));
  search_.reset(options_.module->create(name_of(options_.algorithm), options_.axes, options_.objectives,
                                        options_.population, seed));
  next();
}

// Waits for the next generation.
void ModuleSearch::next() {
  const double* position = options_.module->ask(search_.get());
  if (position == nullptr) throw std::runtime_error(options_.module->error(search_.get()));
  individuals_.assign(options_.population, Vector(options_.axes));
  NumberHash hash(asked_);
  for (Vector& individual : individuals_) {
    individual.assign(position, position + options_.axes);
    position += options_.axes;
    hash.add(individual);
  }
  asked_ = hash.value();
}

void ModuleSearch::tell_costs(const std::vector<double>& costs) {
  for (std::size_t i = 0; i < costs.size(); i++) {
    if (worst_.size() < options_.objectives) worst_.push_back(costs[i]);
    double& worst = worst_[i % options_.objectives];
    worst = std::max(worst, costs[i]);
    fmt::format_to(std::back_inserter(costs_), "{:016x}", std::bit_cast<std::uint64_t>(costs[i]));
  }
  options_.module->tell(search_.get(), costs.data());
  generation_++;
  next();
}

// A failed individual has the largest costs so far, those of this generation included.
std::vector<double> ModuleSearch::costs_of(const std::vector<Evaluated>& values) {
  std::vector<double> worst = worst_;
  const auto failed = [](const Evaluated& value) {
    return !std::ranges::all_of(value.objectives, [](double objective) { return std::isfinite(objective); });
  };
  const auto cost = [](double objective) { return std::clamp(-objective, -kMaxCost, kMaxCost); };
  for (const Evaluated& value : values) {
    if (failed(value)) continue;
    worst.resize(options_.objectives, -kMaxCost);
    for (std::size_t k = 0; k < worst.size(); k++) worst[k] = std::max(worst[k], cost(value.objectives[k]));
  }
  worst.resize(options_.objectives, 0.0);  // if all failed
  std::vector<double> costs;
  for (const Evaluated& value : values) {
    for (std::size_t k = 0; k < worst.size(); k++)
      costs.push_back(failed(value) ? worst[k] : cost(value.objectives[k]));
  }
  return costs;
}

void ModuleSearch::tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) {
  for (std::size_t i = 0; i < values.size(); i++)
    elites_.add({individuals[i], values[i].objectives, {}, generation_, i, values[i].hash});
  tell_costs(costs_of(values));
}

std::string ModuleSearch::save() const {
  return Json{{"costs", costs_}, {"asked", asked_}, {"elites", elites_.save()}}.dump();
}

Result<void> ModuleSearch::restore(std::string_view text) try {
  const Json json = Json::parse(text);
  const std::optional<std::vector<double>> costs = parse_costs(json.at("costs").get<std::string>());
  const std::size_t size = options_.population * options_.objectives;  // of a generation
  if (!costs || costs->size() % size != 0 || costs->size() / options_.objectives > kMaxEvaluations)
    return Error{"the state of the search is damaged"};
  const auto asked = json.at("asked").get<std::uint64_t>();
  if (Result<void> restored = elites_.restore(json.at("elites").get<std::string>()); !restored) return restored;
  generation_ = costs->size() / size;
  if (options_.module == nullptr) return {};
  generation_ = 0;
  worst_.clear();
  costs_.clear();
  asked_ = kHashStart;
  start();
  for (auto at = costs->begin(); at != costs->end(); at += static_cast<std::ptrdiff_t>(size))
    tell_costs({at, at + static_cast<std::ptrdiff_t>(size)});
  if (asked == asked_) return {};
  return Error{
      "the algorithm proposes other individuals than before, so it is another version of pagmo, or the file was "
      "changed; continue on a system like the one before, or start again with --overwrite"};
} catch (const Json::exception&) {
  return Error{"the state of the search is damaged"};
}

}  // namespace limber::experiments
