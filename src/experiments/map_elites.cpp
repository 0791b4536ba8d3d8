// MAP-Elites: variation, archive, state.
#include "experiments/map_elites.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

std::size_t pick(Random& random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(count)), count - 1);
}

}  // namespace

std::uint64_t MapElites::cells() const {
  std::uint64_t count = 1;
  for (const ResultInfo& descriptor : options_.descriptors) count *= static_cast<std::uint64_t>(descriptor.cells);
  return count;
}

std::uint64_t MapElites::cell_along(const ResultInfo& descriptor, double value) {
  const double at = std::floor((value - descriptor.min) / (descriptor.max - descriptor.min) * descriptor.cells);
  return static_cast<std::uint64_t>(std::clamp(at, 0.0, static_cast<double>(descriptor.cells - 1)));
}

std::uint64_t MapElites::cell_of(const Vector& descriptors) const {
  std::uint64_t cell = 0;
  for (std::size_t i = 0; i < options_.descriptors.size(); i++) {
    const ResultInfo& axis = options_.descriptors[i];
    cell = cell * static_cast<std::uint64_t>(axis.cells) + cell_along(axis, descriptors[i]);
  }
  return cell;
}

std::vector<MapElites::Vector> MapElites::ask() const {
  // each generation has a generator of its own, so that the state needs none
  std::uint64_t mixed = options_.seed ^ (generation_ + 1) * 0x9e3779b97f4a7c15u;
  Random random(splitmix64(mixed), "map-elites");
  std::vector<const Elite*> elites;
  for (const auto& [cell, elite] : elites_) elites.push_back(&elite);
  const bool uniform = generation_ < options_.random_generations || elites.empty();
  std::vector<Vector> individuals(options_.batch, Vector(options_.axes));
  for (Vector& individual : individuals) {
    if (uniform) {
      for (double& position : individual) position = random.uniform();
      continue;
    }
    const Vector& a = elites[pick(random, elites.size())]->individual;
    const Vector& b = elites[pick(random, elites.size())]->individual;
    const double along = kDirectional * random.normal();
    for (std::size_t i = 0; i < individual.size(); i++) {
      const double position = a[i] + kIsotropic * random.normal() + along * (b[i] - a[i]);
      individual[i] = std::clamp(position, 0.0, 1.0);
    }
  }
  return individuals;
}

void MapElites::tell(const std::vector<Vector>& individuals, const std::vector<Evaluated>& values) {
  for (std::size_t i = 0; i < individuals.size(); i++) {
    const Evaluated& value = values[i];
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!finite(value.fitness) || !std::ranges::all_of(value.descriptors, finite)) continue;
    const auto [at, is_new] = elites_.try_emplace(cell_of(value.descriptors));
    if (!is_new && !(value.fitness > at->second.fitness)) continue;
    at->second = {individuals[i], value.fitness, value.descriptors, generation_, i, value.hash};
  }
  generation_++;
}

std::string MapElites::save() const {
  Json elites = Json::array();
  for (const auto& [cell, e] : elites_)
    elites.push_back({cell, e.individual, e.fitness, e.descriptors, e.generation, e.index, e.hash});
  return Json{{"generation", generation_}, {"elites", elites}}.dump();
}

Result<void> MapElites::restore(std::string_view text) try {
  const Json json = Json::parse(text);
  std::map<std::uint64_t, Elite> elites;
  for (const Json& e : json.at("elites")) {
    Elite elite{e.at(1).get<Vector>(), e.at(2), e.at(3).get<Vector>(), e.at(4), e.at(5), e.at(6)};
    if (elite.individual.size() != options_.axes || elite.descriptors.size() != options_.descriptors.size())
      return Error{"the saved archive has other parameters or descriptors"};
    elites[e.at(0)] = std::move(elite);
  }
  generation_ = json.at("generation");
  elites_ = std::move(elites);
  return {};
} catch (const Json::exception&) {
  return Error{"the state of the search is damaged"};
}

}  // namespace limber::experiments
