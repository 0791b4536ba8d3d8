// Toy: a small class of things with one row of every kind, for tests of the store and the catalog.
#pragma once

#include <string>
#include <vector>

#include "params/store.h"

namespace limber::test {

struct Toy {
  int mass_effects = 0;
  int pose_effects = 0;
  int rounds = 0;  ///< How often the effect of `chain` marks itself again.
  double doubled = 0;
  bool holds_mass = false;
  Store* store = nullptr;
  NodeId id;

  static const Table& table();

  void effect_mass() { mass_effects++; }
  void effect_pose() { pose_effects++; }
  void effect_chain() {
    rounds++;
    store->mark(id, table().at("chain"));
  }
  void read_twice(double* out) const { out[0] = 2 * doubled; }
  void write_twice(const double* in) { doubled = in[0] / 2; }
  void read_only(double* out) const { out[0] = 42; }
  Result<void> refuse_mass(const double* in) const {
    if (holds_mass && in[0] > 5) return Error{"it is nailed down"};
    return {};
  }
  Result<void> act_kick(std::span<const double>) { return {}; }
};

inline const Table& Toy::table() {
  using namespace rows;
  static const Table table(
      "toy", "/toys/<toy>", "/seed/toy",
      {
          refuse<&Toy::refuse_mass>(effect<&Toy::effect_mass>(number("mass", "kg", 1, 0.5, 10, "Mass."))),
          effect<&Toy::effect_mass>(number("density", "", 2, 0, 100, "Same effect as mass.")),
          integer("count", 3, 0, 9, "A whole number."),
          boolean("awake", true, "Yes or no."),
          choice("mode", {"off", "on", "auto"}, 1, "One of three."),
          vec3("size", "m", {1, 2, 3}, -5, 5, "Three numbers."),
          flags3("active", {false, true, false}, "Three flags."),
          live(state(effect<&Toy::effect_pose>(vec3("position", "m", {0, 0, 0}, -100, 100, "Where it is.")))),
          live(state(effect<&Toy::effect_pose>(quat("rotation", "How it is turned.")))),
          live(readout(number("speed", "m/s", 0, 0, kUnbounded, "How fast it is."))),
          state(view<&Toy::read_twice, &Toy::write_twice>(number("twice", "", 0, -10, 10, "A view."))),
          readout(view<&Toy::read_only>(number("answer", "", 0, 0, 100, "A view that can't be set."))),
          effect<&Toy::effect_chain>(number("chain", "", 0, 0, 1, "Its effect marks it again.")),
          act<&Toy::act_kick>(action("kick", 0, 1, "Something to do.")),
      });
  return table;
}

/// Numbers of a row.
inline std::vector<double> read(const Store& store, NodeId id, const char* row) {
  const Row& r = store.table(id).at(row);
  std::vector<double> out(r.width);
  store.get(id, r, out.data());
  return out;
}

inline Result<SetOutcome> set(Store& store, NodeId id, const char* row, std::vector<double> values) {
  return store.set(id, row, values);
}

}  // namespace limber::test
