// Hashes of values: a value at its default adds nothing, and a new property does not change existing hashes.
#include "properties/values_hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

namespace limber {
namespace {

using properties::boolean;
using properties::number;
using properties::readout;
using properties::state;
using properties::transient;
using properties::vec3;

Property mass() { return number("mass", "kg", 1, 0, 100, "Mass."); }
Property pull() { return vec3("pull", "N", {0, 0, -1}, -10, 10, "Pull."); }
Property pose() { return transient(state(vec3("pose", "m", {0, 0, 0}, -10, 10, "Pose."))); }

// The table of one version.
const PropertyTable& older() {
  static const PropertyTable table("thing", "/thing", "", {mass(), pull(), pose()});
  return table;
}

// The table of a later version: new properties of each kind before, between and after the old ones, in another order.
const PropertyTable& newer() {
  static const PropertyTable table(
      "thing", "/thing", "",
      {boolean("bright", true, "New."), transient(readout(number("heat", "", 0, 0, 9, "New."))), pull(),
       vec3("wind", "N", {1, 2, 3}, -9, 9, "New."), mass(), transient(state(number("phase", "", 0.5, 0, 1, "New."))),
       pose(), readout(number("load", "", 0, 0, 9, "New.")), number("last", "", 0, 0, 1, "New.")});
  return table;
}

struct Hashed {
  explicit Hashed(const PropertyTable& table) : table(table), id(store.add(table, store.root(), "thing", nullptr)) {}
  void write(std::string_view property, std::size_t at, double value) {
    store.mutable_values(id, table.at(property))[at] = value;
  }
  std::uint64_t hash() const { return node_hash(store, id); }

  const PropertyTable& table;
  Store store;
  NodeId id;
};

void change(Hashed& thing) {
  thing.write("mass", 0, 2.5);
  thing.write("pull", 1, 0.25);
  thing.write("pose", 0, -3);
  thing.write("pose", 2, 1e-9);
}

TEST(ValuesHash, DefaultsAddNothing) {
  EXPECT_EQ(Hashed(older()).hash(), 0u);
  EXPECT_EQ(Hashed(newer()).hash(), 0u);
  EXPECT_EQ(fixed_node_hash(Hashed(newer()).store, Hashed(newer()).id), 0u);
}

TEST(ValuesHash, NewPropertiesDoNotChangeIt) {
  Hashed old(older());
  Hashed now(newer());
  change(old);
  EXPECT_NE(old.hash(), now.hash());
  change(now);
  EXPECT_EQ(old.hash(), now.hash());
  EXPECT_EQ(persistent_hash(old.store, old.id), persistent_hash(now.store, now.id));
  // Readouts are not hashed, since they follow from the rest.
  now.write("heat", 0, 5);
  now.write("load", 0, 5);
  EXPECT_EQ(old.hash(), now.hash());
  // Each one changes the hash unless it is at its default.
  for (const char* name : {"bright", "wind", "phase", "last"}) {
    const double was = now.store.values(now.id, now.table.at(name))[0];
    now.write(name, 0, 0.125);
    EXPECT_NE(old.hash(), now.hash()) << name;
    now.write(name, 0, was);
    EXPECT_EQ(old.hash(), now.hash()) << name;
  }
}

TEST(ValuesHash, DependsOnEveryBitOfEveryNumber) {
  Hashed thing(older());
  change(thing);
  std::set<std::uint64_t> seen{thing.hash()};
  for (const char* name : {"mass", "pull", "pose"}) {
    const Property& property = older().at(name);
    for (std::size_t i = 0; i < property.width; i++) {
      const double was = thing.store.values(thing.id, property)[i];
      for (int bit = 0; bit < 64; bit++) {
        thing.write(name, i, std::bit_cast<double>(std::bit_cast<std::uint64_t>(was) ^ (std::uint64_t{1} << bit)));
        EXPECT_TRUE(seen.insert(thing.hash()).second) << name << " " << i << " bit " << bit;
      }
      thing.write(name, i, was);
    }
  }
  // The same numbers at other positions.
  thing.write("pull", 0, 0.25);
  thing.write("pull", 1, 0);
  EXPECT_TRUE(seen.insert(thing.hash()).second);
}

TEST(ValuesHash, FixedNodesOfDifferentClassesDiffer) {
  static const PropertyTable one("one", "/one", "", {mass()});
  static const PropertyTable two("two", "/two", "", {mass()});
  Hashed a(one);
  Hashed b(two);
  a.write("mass", 0, 3);
  b.write("mass", 0, 3);
  EXPECT_EQ(persistent_hash(a.store, a.id), persistent_hash(b.store, b.id));
  EXPECT_NE(fixed_node_hash(a.store, a.id), fixed_node_hash(b.store, b.id));
}

}  // namespace
}  // namespace limber
