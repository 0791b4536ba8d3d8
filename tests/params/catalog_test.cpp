// The catalog: addresses to places by exact path and by pattern.
#include "params/catalog.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "params/toy.h"

namespace limber {
namespace {

using test::Toy;

struct Catalog : testing::Test {
  Catalog() {
    for (const char* name : {"bear", "Bear2", "left leg", "a/b", "duck"}) {
      const NodeId id = store.add(Toy::table(), toys, name, &toy);
      const NodeId parts = store.add_group(id, "part");
      for (const char* part : {"head", "tail"}) store.add(Toy::table(), parts, part, &toy);
    }
  }
  std::string found(std::string_view path) {
    const Result<Place> place = find_place(store, path);
    if (!place) return place.error();
    return store.path(place->node) + (place->row != nullptr ? " " + place->row->name : "");
  }
  std::vector<std::string> matched(std::string_view pattern, std::size_t limit = 1000000) {
    PatternBudget budget;
    const Result<std::vector<Place>> places = match_places(store, pattern, budget, limit);
    if (!places) return {places.error()};
    std::vector<std::string> out;
    for (const Place& p : *places) out.push_back(store.path(p.node) + (p.row != nullptr ? " " + p.row->name : ""));
    return out;
  }
  Store store;
  Toy toy;
  NodeId toys = store.add_group(store.root(), "toys");
};

using Paths = std::vector<std::string>;

TEST_F(Catalog, FindsPlacesByPath) {
  EXPECT_EQ(found("/"), "/");
  EXPECT_EQ(found("/toys"), "/toys");
  EXPECT_EQ(found("/toys/bear"), "/toys/bear");
  EXPECT_EQ(found("/toys/bear/"), "/toys/bear");
  EXPECT_EQ(found("/toys/bear/mass"), "/toys/bear mass");
  EXPECT_EQ(found("/toys/bear/part/head/position"), "/toys/bear/part/head position");
}

TEST_F(Catalog, ComparesTheHousesNamesLooselyAndTheUsersExactly) {
  EXPECT_EQ(found("/Toys/bear/PART/head/Ma_ss"), "/toys/bear/part/head mass");
  EXPECT_EQ(found("/toys/Bear2"), "/toys/Bear2");
  EXPECT_EQ(found("/toys/bear2"), "there is no 'bear2' in /toys; did you mean 'Bear2'?");
  EXPECT_EQ(found("/toys/Bear/mass"), "there is no 'Bear' in /toys; did you mean 'bear'?");
}

TEST_F(Catalog, UndoesEscapes) {
  EXPECT_EQ(found("/toys/left%20leg/mass"), "/toys/left%20leg mass");
  EXPECT_EQ(found("/toys/left leg/mass"), "/toys/left%20leg mass");
  EXPECT_EQ(found("/toys/a%2Fb/mass"), "/toys/a%2Fb mass");
  EXPECT_EQ(matched("/toys/a%2Fb/m?ss"), Paths{"/toys/a%2Fb mass"});
  EXPECT_EQ(matched("/toys/left*/mass"), Paths{"/toys/left%20leg mass"});
}

TEST_F(Catalog, SaysWhereAPathFailsAndWhatIsNear) {
  EXPECT_EQ(found(""), "'' is no address: it must begin with /");
  EXPECT_EQ(found("toys"), "'toys' is no address: it must begin with /");
  EXPECT_EQ(found("/toys/bear/masss"), "there is no 'masss' in /toys/bear; did you mean 'mass'?");
  EXPECT_EQ(found("/toys/bear/part/haed/mass"), "there is no 'haed' in /toys/bear/part; did you mean 'head'?");
  EXPECT_EQ(found("/toys/bear/mass/x"), "there is no 'mass' in /toys/bear; did you mean 'mass'?");
  EXPECT_EQ(found("/nothing"), "there is no 'nothing' in /; there are: toys");
}

TEST_F(Catalog, MatchesPatternsInTreeOrder) {
  EXPECT_EQ(matched("/toys/*/mass"), (Paths{"/toys/bear mass", "/toys/Bear2 mass", "/toys/left%20leg mass",
                                            "/toys/a%2Fb mass", "/toys/duck mass"}));
  EXPECT_EQ(matched("/toys/{duck,bear}/mass"), (Paths{"/toys/bear mass", "/toys/duck mass"}));
  EXPECT_EQ(matched("/toys/[bd]*/count"), (Paths{"/toys/bear count", "/toys/duck count"}));
  EXPECT_EQ(matched("/toys/[!bBl]*/count"), (Paths{"/toys/a%2Fb count", "/toys/duck count"}));
  EXPECT_EQ(matched("/toys/bear/{mass,count}"), (Paths{"/toys/bear mass", "/toys/bear count"}));
  EXPECT_EQ(matched("/toys/bear/part/*/s*"), (Paths{"/toys/bear/part/head size", "/toys/bear/part/head speed",
                                                    "/toys/bear/part/tail size", "/toys/bear/part/tail speed"}));
  EXPECT_EQ(matched("/TOYS/duck/p?rt/head/mass"), Paths{"/toys/duck/part/head mass"});
  EXPECT_EQ(matched("/toys/d*/part/head/MA*"), Paths{"/toys/duck/part/head mass"});
  EXPECT_EQ(matched("/toys/x*/mass"), Paths{});
  EXPECT_EQ(matched("/toys/*/part/head/nothing"), Paths{});
}

TEST_F(Catalog, TwoSlashesMeanAnyDepth) {
  EXPECT_EQ(matched("//duck/mass"), Paths{"/toys/duck mass"});
  EXPECT_EQ(matched("//head/mass").size(), 5u);
  EXPECT_EQ(matched("//mass").size(), 15u);
  EXPECT_EQ(matched("/toys/duck//mass"),
            (Paths{"/toys/duck mass", "/toys/duck/part/head mass", "/toys/duck/part/tail mass"}));
}

TEST_F(Catalog, AnExactPatternIsAPathWithItsError) {
  EXPECT_EQ(matched("/toys/bear/mass"), Paths{"/toys/bear mass"});
  EXPECT_EQ(matched("/toys/baer/mass"), Paths{found("/toys/baer/mass")});
  EXPECT_EQ(matched("*"), Paths{"'*' is no address: it must begin with /"});
}

TEST_F(Catalog, GivesAtMostTheLimit) {
  EXPECT_EQ(matched("//mass", 4).size(), 4u);
  EXPECT_EQ(matched("/toys/*/*", 7).size(), 7u);
}

// Without a bound `//` repeated n times walks a tree of depth d in d^n ways.
TEST_F(Catalog, APatternsCostIsBounded) {
  NodeId at = toys;
  for (int i = 0; i < 60; i++) at = store.add_group(at, "deep");
  std::string pattern;
  for (int i = 0; i < 20; i++) pattern += "//*";
  EXPECT_EQ(matched(pattern + "/nothing"), Paths{});
  EXPECT_EQ(matched("/toys/bear//mass").size(), 3u);
}

TEST_F(Catalog, APatternThatIsTooMuchWorkIsRefusedWhole) {
  for (int i = 0; i < 200; i++) store.add(Toy::table(), toys, fmt::format("aaaaaaaaaaaaaaaaaaaaaaaa{}", i), &toy);
  // the stars alone need more steps for one name than this budget has for all
  const std::string evil = "/toys/*a*a*a*a*a*a*a*b/mass";
  PatternBudget small{20000};
  const Result<std::vector<Place>> places = match_places(store, evil, small);
  ASSERT_FALSE(places.ok());
  EXPECT_EQ(places.error(),
            "the pattern '" + evil + "' is too much work; say more of the path, or send fewer at a time");
  EXPECT_TRUE(small.over());
  // what is spent is a few names' worth beyond it at most
  EXPECT_GT(small.left, -30000);
  // what was found before the work was too much counts for nothing either
  PatternBudget half{100 * PatternBudget::kName};
  EXPECT_FALSE(match_places(store, "/toys/*/mass", half).ok());
  // an exact path costs nothing, and one that is cheap is found with what is left
  PatternBudget left{20 * PatternBudget::kName};
  EXPECT_TRUE(match_places(store, "/toys/duck/mass", left).ok());
  EXPECT_EQ(left.left, 20 * PatternBudget::kName);
  EXPECT_EQ(match_places(store, "/toys/duck/part/*/mass", left)->size(), 2u);
  EXPECT_FALSE(match_places(store, "/toys/*/part/*/mass", left).ok());
}

TEST_F(Catalog, EachPlaceIsFoundOnce) {
  Paths all = matched("//part//mass");
  const std::size_t count = all.size();
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  EXPECT_EQ(all.size(), count);
  EXPECT_EQ(count, 10u);
  EXPECT_EQ(matched("////mass").size(), 15u);
}

}  // namespace
}  // namespace limber
