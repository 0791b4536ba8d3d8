// Toy: a small class with one property of every kind, for tests of the store and the catalog.
#pragma once

#include <string>
#include <vector>

#include "properties/store.h"

namespace limber::test {

struct Toy {
  int mass_callbacks = 0;
  int pose_callbacks = 0;
  int rounds = 0;  ///< Calls of the callback of `chain`, which marks `chain` dirty again.
  double doubled = 0;
  bool rejects_large_mass = false;
  Store* store = nullptr;
  NodeId id;

  static const PropertyTable& table();

  void on_mass_change() { mass_callbacks++; }
  void on_pose_change() { pose_callbacks++; }
  void on_chain_change() {
    rounds++;
    store->mark_dirty(id, table().at("chain"));
  }
  void read_twice(double* out) const { out[0] = 2 * doubled; }
  void write_twice(const double* in) { doubled = in[0] / 2; }
  void read_answer(double* out) const { out[0] = 42; }
  Result<void> validate_mass(const double* in) const {
    if (rejects_large_mass && in[0] > 5) return Error{"it is fixed"};
    return {};
  }
  Result<void> kick(std::span<const double>) { return {}; }
};

inline const PropertyTable& Toy::table() {
  using namespace properties;
  static const PropertyTable table(
      "toy", "/toys/<toy>", "/legacy/toy",
      {
          validated_by<&Toy::validate_mass>(on_change<&Toy::on_mass_change>(number("mass", "kg", 1, 0.5, 10, "Mass."))),
          on_change<&Toy::on_mass_change>(number("density", "", 2, 0, 100, "Same callback as mass.")),
          integer("count", 3, 0, 9, "A whole number."),
          boolean("awake", true, "Yes or no."),
          choice("mode", {"off", "on", "auto"}, 1, "One of three."),
          vec3("size", "m", {1, 2, 3}, -5, 5, "Three numbers."),
          flags3("active", {false, true, false}, "Three flags."),
          transient(
              state(on_change<&Toy::on_pose_change>(vec3("position", "m", {0, 0, 0}, -100, 100, "Where it is.")))),
          transient(state(on_change<&Toy::on_pose_change>(quat("rotation", "How it is turned.")))),
          transient(readout(number("speed", "m/s", 0, 0, kUnbounded, "How fast it is."))),
          state(computed<&Toy::read_twice, &Toy::write_twice>(number("twice", "", 0, -10, 10, "A computed property."))),
          readout(computed<&Toy::read_answer>(number("answer", "", 0, 0, 100, "A computed readout."))),
          on_change<&Toy::on_chain_change>(number("chain", "", 0, 0, 1, "Its callback marks it dirty again.")),
          invokes<&Toy::kick>(action("kick", 0, 1, "Something to do.")),
      });
  return table;
}

/// Returns the numbers of a property.
inline std::vector<double> read(const Store& store, NodeId id, const char* property) {
  const Property& r = store.table(id).at(property);
  std::vector<double> out(r.width);
  store.get(id, r, out.data());
  return out;
}

inline Result<SetOutcome> set(Store& store, NodeId id, const char* property, std::vector<double> values) {
  return store.set(id, property, values);
}

}  // namespace limber::test
