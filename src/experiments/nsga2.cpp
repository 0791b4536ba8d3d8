// NSGA-II: sorting, selection, variation, state.
#include "experiments/nsga2.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/math/fixed_math.h"
#include "experiments/elite_list.h"

namespace limber::experiments {

namespace {

using Json = nlohmann::json;

bool is_valid(const std::vector<double>& objectives) {
  return std::ranges::all_of(objectives, [](double x) { return std::isfinite(x); });
}

// a failed individual is dominated by all that succeeded
bool is_dominated_by(const std::vector<double>& a, const std::vector<double>& b) {
  const bool valid = is_valid(a);
  return valid == is_valid(b) ? valid && dominates(b, a) : !valid;
}

std::size_t pick_below(Random& random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(count)), count - 1);
}

// the spread of a child around its parents for a uniform number `u`; `bound`: distance of the nearer bound of the range
// from its parent, relative to half of the parents' distance (Deb, Agrawal 1995)
double spread(double u, double bound) {
  const double exponent = 1 / (Nsga2::kCrossoverIndex + 1);
  const double alpha = 2 - fixed::pow(1 + bound, -(Nsga2::kCrossoverIndex + 1));
  return u <= 1 / alpha ? fixed::pow(u * alpha, exponent) : fixed::pow(1 / (2 - u * alpha), exponent);
}

}  // namespace

Nsga2::Nsga2(const Options& options) : options_(options) {
  if (options_.population == 0) options_.population = kPopulation;
  options_.population = std::clamp<std::size_t>((options_.population + 1) / 2 * 2, 4, kMaxPopulation);
}

void Nsga2::rank(std::vector<Member>& members) {
  std::vector<std::size_t> dominators(members.size(), 0);
  std::vector<std::vector<std::size_t>> dominated(members.size());
  for (std::size_t i = 0; i < members.size(); i++) {
    for (std::size_t k = 0; k < members.size(); k++) {
      if (!is_dominated_by(members[k].objectives, members[i].objectives)) continue;
      dominated[i].push_back(k);
      dominators[k]++;
    }
  }
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < members.size(); i++) {
    if (dominators[i] == 0) front.push_back(i);
  }
  for (std::size_t number = 0; !front.empty(); number++) {
    std::vector<const Vector*> points;
    points.reserve(front.size());
    for (const std::size_t i : front) points.push_back(&members[i].objectives);
    const bool valid = is_valid(*points.front());
    const Vector distances = valid ? crowding_distances(points) : Vector(points.size(), 0.0);
    std::vector<std::size_t> next;
    for (std::size_t n = 0; n < front.size(); n++) {
      members[front[n]].front = number;
      members[front[n]].distance = distances[n];
      for (const std::size_t k : dominated[front[n]]) {
        if (--dominators[k] == 0) next.push_back(k);
      }
    }
    std::ranges::sort(next);
    front = std::move(next);
  }
}

const Nsga2::Member& Nsga2::tournament(Random& random) const {
  const Member& a = parents_[pick_below(random, parents_.size())];
  const Member& b = parents_[pick_below(random, parents_.size())];
  if (a.front != b.front) return a.front < b.front ? a : b;
  return b.distance > a.distance ? b : a;
}

// Simulated binary crossover within the range.
void Nsga2::cross(Vector& a, Vector& b, Random& random) const {
  if (random.uniform() >= kCrossover) return;
  for (std::size_t i = 0; i < a.size(); i++) {
    const bool crossed = random.uniform() < 0.5;
    const double u = random.uniform();
    const bool swapped = random.uniform() < 0.5;
    const double low = std::min(a[i], b[i]);
    const double high = std::max(a[i], b[i]);
    if (!crossed || high - low < 1e-14) continue;
    const double middle = (low + high) / 2;
    const double half = (high - low) / 2;
    const double below = std::clamp(middle - half * spread(u, low / half), 0.0, 1.0);
    const double above = std::clamp(middle + half * spread(u, (1 - high) / half), 0.0, 1.0);
    a[i] = swapped ? above : below;
    b[i] = swapped ? below : above;
  }
}

// Polynomial mutation within the range.
void Nsga2::mutate(Vector& individual, Random& random) const {
  const double probability = 1 / static_cast<double>(individual.size());
  const double exponent = 1 / (kMutationIndex + 1);
  for (double& x : individual) {
    const bool mutated = random.uniform() < probability;
    const double u = random.uniform();
    if (!mutated) continue;
    const double beyond = fixed::pow(u < 0.5 ? 1 - x : x, kMutationIndex + 1);
    const double step = u < 0.5 ? fixed::pow(2 * u + (1 - 2 * u) * beyond, exponent) - 1
                                : 1 - fixed::pow(2 * (1 - u) + 2 * (u - 0.5) * beyond, exponent);
    x = std::clamp(x + step, 0.0, 1.0);
  }
}

std::vector<Nsga2::Vector> Nsga2::ask() const {
  // each generation has a generator of its own, so that the state needs none
  std::uint64_t mixed = options_.seed ^ (generation_ + 1) * 0x9e3779b97f4a7c15u;
  Random random(splitmix64(mixed), "nsga2");
  std::vector<Vector> individuals;
  while (individuals.size() < options_.population) {
    if (parents_.empty()) {
      Vector& individual = individuals.emplace_back(options_.axes);
      for (double& position : individual) position = random.uniform();
      continue;
    }
    Vector a = tournament(random).individual;
    Vector b = tournament(random).individual;
    cross(a, b, random);
    mutate(a, random);
    mutate(b, random);
    individuals.push_back(std::move(a));
    individuals.push_back(std::move(b));
  }
  return individuals;
}

void Nsga2::tell(const std::vector<Vector>& individuals, const std::vector<Vector>& objectives) {
  for (std::size_t i = 0; i < individuals.size(); i++) parents_.push_back({individuals[i], objectives[i]});
  rank(parents_);
  std::ranges::stable_sort(parents_, [](const Member& a, const Member& b) {
    return a.front != b.front ? a.front < b.front : a.distance > b.distance;
  });
  parents_.resize(std::min(parents_.size(), options_.population));
  rank(parents_);
  generation_++;
}

std::string Nsga2::save() const {
  Json parents = Json::array();
  for (const Member& member : parents_) {
    // JSON has no NaN
    const Vector none;
    parents.push_back({member.individual, is_valid(member.objectives) ? member.objectives : none});
  }
  return Json{{"generation", generation_}, {"parents", parents}}.dump();
}

Result<void> Nsga2::restore(std::string_view text) try {
  const Json json = Json::parse(text);
  std::vector<Member> parents;
  for (const Json& entry : json.at("parents")) {
    Member member{entry.at(0).get<Vector>(), entry.at(1).get<Vector>()};
    if (member.objectives.empty()) member.objectives.assign(options_.objectives, std::nan(""));
    if (member.individual.size() != options_.axes || member.objectives.size() != options_.objectives)
      return Error{"the saved search has other parameters or objectives"};
    parents.push_back(std::move(member));
  }
  const std::uint64_t generation = json.at("generation");
  if (parents.size() != (generation == 0 ? 0 : options_.population)) return Error{"the state of the search is damaged"};
  generation_ = generation;
  parents_ = std::move(parents);
  rank(parents_);
  return {};
} catch (const Json::exception&) {
  return Error{"the state of the search is damaged"};
}

}  // namespace limber::experiments
