// Hashes of values: a value at its default adds nothing, and a new property leaves the hashes of before as they are.
#include "params/values_hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

namespace limber {
namespace {

using rows::boolean;
using rows::live;
using rows::number;
using rows::readout;
using rows::state;
using rows::vec3;

Row mass() { return number("mass", "kg", 1, 0, 100, "Mass."); }
Row pull() { return vec3("pull", "N", {0, 0, -1}, -10, 10, "Pull."); }
Row pose() { return live(state(vec3("pose", "m", {0, 0, 0}, -10, 10, "Pose."))); }

// as it is in one version
const Table& older() {
  static const Table table("thing", "/thing", "", {mass(), pull(), pose()});
  return table;
}

// as it is in a later one: new rows of each kind in front, between and behind, and the old ones in another order
const Table& newer() {
  static const Table table(
      "thing", "/thing", "",
      {boolean("bright", true, "New."), live(readout(number("heat", "", 0, 0, 9, "New."))), pull(),
       vec3("wind", "N", {1, 2, 3}, -9, 9, "New."), mass(), live(state(number("phase", "", 0.5, 0, 1, "New."))), pose(),
       readout(number("load", "", 0, 0, 9, "New.")), number("last", "", 0, 0, 1, "New.")});
  return table;
}

struct Hashed {
  explicit Hashed(const Table& table) : table(table), id(store.add(table, store.root(), "thing", nullptr)) {}
  void write(std::string_view row, std::size_t at, double value) { store.tell(id, table.at(row))[at] = value; }
  std::uint64_t hash() const { return node_hash(store, id); }

  const Table& table;
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

TEST(ValuesHash, NewPropertiesLeaveItAsItIs) {
  Hashed old(older());
  Hashed now(newer());
  change(old);
  EXPECT_NE(old.hash(), now.hash());
  change(now);
  EXPECT_EQ(old.hash(), now.hash());
  EXPECT_EQ(kept_hash(old.store, old.id), kept_hash(now.store, now.id));
  // readouts follow from the rest
  now.write("heat", 0, 5);
  now.write("load", 0, 5);
  EXPECT_EQ(old.hash(), now.hash());
  // away from its default each one counts, and back at it no longer
  for (const char* name : {"bright", "wind", "phase", "last"}) {
    const double was = now.store.values(now.id, now.table.at(name))[0];
    now.write(name, 0, 0.125);
    EXPECT_NE(old.hash(), now.hash()) << name;
    now.write(name, 0, was);
    EXPECT_EQ(old.hash(), now.hash()) << name;
  }
}

TEST(ValuesHash, SeesEveryBitOfEveryNumber) {
  Hashed thing(older());
  change(thing);
  std::set<std::uint64_t> seen{thing.hash()};
  for (const char* name : {"mass", "pull", "pose"}) {
    const Row& row = older().at(name);
    for (std::size_t i = 0; i < row.width; i++) {
      const double was = thing.store.values(thing.id, row)[i];
      for (int bit = 0; bit < 64; bit++) {
        thing.write(name, i, std::bit_cast<double>(std::bit_cast<std::uint64_t>(was) ^ (std::uint64_t{1} << bit)));
        EXPECT_TRUE(seen.insert(thing.hash()).second) << name << " " << i << " bit " << bit;
      }
      thing.write(name, i, was);
    }
  }
  // the same numbers in other places
  thing.write("pull", 0, 0.25);
  thing.write("pull", 1, 0);
  EXPECT_TRUE(seen.insert(thing.hash()).second);
}

TEST(ValuesHash, NodesOfEveryWorldAreToldApart) {
  static const Table one("one", "/one", "", {mass()});
  static const Table two("two", "/two", "", {mass()});
  Hashed a(one);
  Hashed b(two);
  a.write("mass", 0, 3);
  b.write("mass", 0, 3);
  EXPECT_EQ(kept_hash(a.store, a.id), kept_hash(b.store, b.id));
  EXPECT_NE(fixed_node_hash(a.store, a.id), fixed_node_hash(b.store, b.id));
}

}  // namespace
}  // namespace limber
