// Variation of the selected individuals, and the generations before.
#include "experiments/breeding.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/hash.h"

namespace limber::experiments {

namespace {

std::size_t index_below(Random& random, std::size_t count) {
  return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(count)), count - 1);
}

// a position beyond a bound comes back from it, so that individuals don't gather at the bounds
double reflected(double position) {
  const double back = position < 0 ? -position : position > 1 ? 2 - position : position;
  return std::clamp(back, 0.0, 1.0);
}

}  // namespace

Breeding::Breeding(std::vector<Axis> axes, const std::vector<Vector>& parents, double amount, std::uint64_t seed)
    : axes_(std::move(axes)), held_(axes_.size()), seed_(seed), history_(1) {
  Generation& first = history_.front();
  const std::size_t count = std::min(parents.size(), kCount);
  for (std::size_t i = 0; i < kCount; i++) {
    first.individuals[i] = parents[i % count];
    first.kept[i] = i < count;
    first.liked[i] = i < count;
  }
  if (!mutate(amount)) return;
  history_.erase(history_.begin());  // the copies of the parents are no generation to return to
  at_ = 0;
}

std::vector<double> Breeding::values(std::size_t individual) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < axes_.size(); i++) values.push_back(axes_[i].at(current().individuals[individual][i]));
  return values;
}

void Breeding::toggle_liked(std::size_t individual) {
  bool& liked = history_[at_].liked[individual];
  liked = !liked;
}

std::vector<std::size_t> Breeding::parents() const {
  std::vector<std::size_t> liked;
  for (std::size_t i = 0; i < kCount; i++) {
    if (current().liked[i]) liked.push_back(i);
  }
  return liked;
}

bool Breeding::next_generation(const MakeChild& make) {
  if (std::ranges::all_of(current().liked, [](bool liked) { return liked; })) return false;
  // each operation has a generator of its own: after an undo, the same operation gives others
  std::uint64_t mixed = seed_ ^ (operations_ + 1) * 0x9e3779b97f4a7c15u;
  Random random(splitmix64(mixed), "breeding");
  Generation next;
  next.number = ++operations_;
  next.kept = current().liked;
  for (std::size_t i = 0; i < kCount; i++)
    next.individuals[i] = next.kept[i] ? current().individuals[i] : make(i, random);
  history_.resize(at_ + 1);
  if (history_.size() == kMaxGenerations) history_.erase(history_.begin());
  history_.push_back(std::move(next));
  at_ = history_.size() - 1;
  return true;
}

Breeding::Vector Breeding::mutated(Vector individual, double amount, Random& random) const {
  for (std::size_t i = 0; i < axes_.size(); i++) {
    const double step = random.normal();
    const double chance = random.uniform();
    const double other = random.uniform();
    if (held_[i]) continue;
    if (!axes_[i].listed) {
      individual[i] = reflected(individual[i] + amount * step);
    } else if (chance < amount) {
      individual[i] = other;
    }
  }
  return individual;
}

Breeding::Vector Breeding::crossed(const Vector& a, const Vector& b, Random& random) const {
  Vector child = a;
  for (std::size_t i = 0; i < axes_.size(); i++) {
    const double along = random.uniform(-kBeyond, 1 + kBeyond);
    if (held_[i]) continue;
    if (axes_[i].listed) {
      child[i] = along < 0.5 ? a[i] : b[i];
    } else {
      child[i] = std::clamp(a[i] + along * (b[i] - a[i]), 0.0, 1.0);
    }
  }
  return child;
}

bool Breeding::mutate(double amount) {
  const std::vector<std::size_t> liked = parents();
  std::size_t turn = 0;  // the liked ones take turns
  return next_generation([&](std::size_t individual, Random& random) {
    const std::size_t parent = liked.empty() ? individual : liked[turn++ % liked.size()];
    return mutated(current().individuals[parent], std::clamp(amount, 0.0, 1.0), random);
  });
}

bool Breeding::cross() {
  std::vector<std::size_t> all(kCount);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<std::size_t> liked = parents();
  return next_generation([&](std::size_t, Random& random) {
    const std::vector<std::size_t>& first = liked.empty() ? all : liked;
    const std::size_t a = first[index_below(random, first.size())];
    std::vector<std::size_t> second = liked.size() < 2 ? all : liked;
    std::erase(second, a);
    const std::size_t b = second[index_below(random, second.size())];
    return crossed(current().individuals[a], current().individuals[b], random);
  });
}

bool Breeding::randomize() {
  return next_generation([&](std::size_t individual, Random& random) {
    Vector child = current().individuals[individual];
    for (std::size_t i = 0; i < axes_.size(); i++) {
      const double position = random.uniform();
      if (!held_[i]) child[i] = position;
    }
    return child;
  });
}

}  // namespace limber::experiments
