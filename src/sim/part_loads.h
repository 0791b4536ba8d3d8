// PartLoads: forces and impulses that wait for the next step, of all parts side by side, so that a tick that pushes
// thousands of them goes through memory in order. [sim]
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace limber {

class Part;

class PartLoads {
 public:
  /// What acts on a part for the whole coming tick, at its centre of mass.
  struct alignas(64) Load {
    Vec3 force{0};   ///< N
    Vec3 torque{0};  ///< N·m
    Part* part = nullptr;
    bool waits = false;
  };
  /// What acts on it at once.
  struct Kick {
    Vec3 impulse{0};          ///< N·s
    Vec3 angular_impulse{0};  ///< N·m·s
  };

  /// A place for a part; those given back are used again.
  std::uint32_t add(Part& part);
  void remove(std::uint32_t place);

  /// To add a force or torque to; it is handed over before the next step.
  Load& load(std::uint32_t place) {
    Load& load = loads_[place];
    if (!load.waits) wait(place);
    return load;
  }
  Kick& kick(std::uint32_t place) {
    if (!loads_[place].waits) wait(place);
    return kicks_[place];
  }
  /// The same by the slot of the part's node; null where no part has it.
  Load* load_of_slot(std::uint32_t slot) {
    const std::uint32_t place = slot < places_.size() ? places_[slot] : kNone;
    return place == kNone ? nullptr : &load(place);
  }
  /// Soon something will be added there.
  [[gnu::always_inline]] void fetch(std::uint32_t place) const { __builtin_prefetch(&loads_[place], 1); }
  void clear(std::uint32_t place);
  /// What waits is lost.
  void drop();
  /// Calls f(load, kick) for each part that something waits for.
  template <class F>
  void each_waiting(F&& f) const {
    for (const std::uint32_t place : waiting_) {
      if (loads_[place].part != nullptr) f(loads_[place], kicks_[place]);
    }
  }
  /// Before Bullet steps: hands over what waits. Nothing waits longer.
  void push();

 private:
  friend class WorldKey;
  void fetch_ahead(std::size_t at) const;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  void wait(std::uint32_t place) {
    loads_[place].waits = true;
    waiting_.push_back(place);
  }

  std::vector<Load> loads_;
  std::vector<Kick> kicks_;
  std::vector<std::uint32_t> waiting_;
  std::vector<std::uint32_t> spare_;
  std::vector<std::uint32_t> places_;  // by slot
};

}  // namespace limber
