// Domination, crowding, state.
#include "experiments/elite_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

}  // namespace

bool dominates(const std::vector<double>& a, const std::vector<double>& b) {
  bool better = false;
  for (std::size_t i = 0; i < a.size(); i++) {
    if (a[i] < b[i]) return false;
    better = better || a[i] > b[i];
  }
  return better;
}

std::vector<double> crowding_distances(const std::vector<const std::vector<double>*>& points) {
  std::vector<double> distances(points.size(), 0.0);
  std::vector<std::size_t> order(points.size());
  const std::size_t objectives = points.empty() ? 0 : points.front()->size();
  for (std::size_t k = 0; k < objectives; k++) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto value = [&](std::size_t i) { return (*points[order[i]])[k]; };
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return (*points[a])[k] < (*points[b])[k]; });
    const double range = value(order.size() - 1) - value(0);
    distances[order.front()] = distances[order.back()] = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < order.size() && range > 0; i++)
      distances[order[i]] += (value(i + 1) - value(i - 1)) / range;
  }
  return distances;
}

void EliteList::add(Elite elite) {
  if (!std::ranges::all_of(elite.objectives, [](double x) { return std::isfinite(x); })) return;
  if (objectives_ == 1) {
    if (elites_.empty() || elite.objectives[0] > elites_.back().objectives[0]) elites_.push_back(std::move(elite));
    return;
  }
  for (const Elite& other : elites_) {
    if (other.objectives == elite.objectives || dominates(other.objectives, elite.objectives)) return;
  }
  std::erase_if(elites_, [&](const Elite& other) { return dominates(elite.objectives, other.objectives); });
  const auto after =
      std::ranges::find_if(elites_, [&](const Elite& other) { return other.objectives < elite.objectives; });
  elites_.insert(after, std::move(elite));
  if (elites_.size() > max_front_) remove_most_crowded();
}

void EliteList::remove_most_crowded() {
  std::vector<const std::vector<double>*> points;
  for (const Elite& elite : elites_) points.push_back(&elite.objectives);
  const std::vector<double> distances = crowding_distances(points);
  elites_.erase(elites_.begin() + (std::ranges::min_element(distances) - distances.begin()));
}

std::string EliteList::save() const {
  Json elites = Json::array();
  for (const Elite& e : elites_) elites.push_back({e.individual, e.objectives, e.generation, e.index, e.hash});
  return elites.dump();
}

Result<void> EliteList::restore(std::string_view text) try {
  std::vector<Elite> elites;
  for (const Json& e : Json::parse(text)) {
    elites.push_back(
        {e.at(0).get<std::vector<double>>(), e.at(1).get<std::vector<double>>(), {}, e.at(2), e.at(3), e.at(4)});
    if (elites.back().individual.size() != axes_ || elites.back().objectives.size() != objectives_)
      return Error{"the saved search has other parameters or objectives"};
  }
  elites_ = std::move(elites);
  return {};
} catch (const Json::exception&) {
  return Error{"the state of the search is damaged"};
}

}  // namespace limber::experiments
