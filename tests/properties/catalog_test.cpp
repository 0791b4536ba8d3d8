// The catalog: lookup of nodes and properties by path and by pattern.
#include "properties/catalog.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "properties/toy.h"

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
    const Result<PropertyRef> place = find_property(store, path);
    if (!place) return place.error();
    return store.path(place->node) + (place->property != nullptr ? " " + place->property->name : "");
  }
  std::vector<std::string> matched(std::string_view pattern, std::size_t limit = 1000000) {
    PatternBudget budget;
    const Result<std::vector<PropertyRef>> places = match_properties(store, pattern, budget, limit);
    if (!places) return {places.error()};
    std::vector<std::string> out;
    for (const PropertyRef& p : *places)
      out.push_back(store.path(p.node) + (p.property != nullptr ? " " + p.property->name : ""));
    return out;
  }
  Store store;
  Toy toy;
  NodeId toys = store.add_group(store.root(), "toys");
};

using Paths = std::vector<std::string>;

TEST_F(Catalog, FindsByPath) {
  EXPECT_EQ(found("/"), "/");
  EXPECT_EQ(found("/toys"), "/toys");
  EXPECT_EQ(found("/toys/bear"), "/toys/bear");
  EXPECT_EQ(found("/toys/bear/"), "/toys/bear");
  EXPECT_EQ(found("/toys/bear/mass"), "/toys/bear mass");
  EXPECT_EQ(found("/toys/bear/part/head/position"), "/toys/bear/part/head position");
}

TEST_F(Catalog, IgnoresCaseOfFixedNamesOnly) {
  EXPECT_EQ(found("/Toys/bear/PART/head/Ma_ss"), "/toys/bear/part/head mass");
  EXPECT_EQ(found("/toys/Bear2"), "/toys/Bear2");
  EXPECT_EQ(found("/toys/bear2"), "there is no 'bear2' in /toys; did you mean 'Bear2'?");
  EXPECT_EQ(found("/toys/Bear/mass"), "there is no 'Bear' in /toys; did you mean 'bear'?");
}

TEST_F(Catalog, DecodesEscapes) {
  EXPECT_EQ(found("/toys/left%20leg/mass"), "/toys/left%20leg mass");
  EXPECT_EQ(found("/toys/left leg/mass"), "/toys/left%20leg mass");
  EXPECT_EQ(found("/toys/a%2Fb/mass"), "/toys/a%2Fb mass");
  EXPECT_EQ(matched("/toys/a%2Fb/m?ss"), Paths{"/toys/a%2Fb mass"});
  EXPECT_EQ(matched("/toys/left*/mass"), Paths{"/toys/left%20leg mass"});
}

TEST_F(Catalog, ErrorNamesTheMissingComponentAndSuggestions) {
  EXPECT_EQ(found(""), "'' is not an address: it must begin with /");
  EXPECT_EQ(found("toys"), "'toys' is not an address: it must begin with /");
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

TEST_F(Catalog, TwoSlashesMatchAnyDepth) {
  EXPECT_EQ(matched("//duck/mass"), Paths{"/toys/duck mass"});
  EXPECT_EQ(matched("//head/mass").size(), 5u);
  EXPECT_EQ(matched("//mass").size(), 15u);
  EXPECT_EQ(matched("/toys/duck//mass"),
            (Paths{"/toys/duck mass", "/toys/duck/part/head mass", "/toys/duck/part/tail mass"}));
}

TEST_F(Catalog, PatternWithoutWildcardsIsAPath) {
  EXPECT_EQ(matched("/toys/bear/mass"), Paths{"/toys/bear mass"});
  EXPECT_EQ(matched("/toys/baer/mass"), Paths{found("/toys/baer/mass")});
  EXPECT_EQ(matched("*"), Paths{"'*' is not an address: it must begin with /"});
}

TEST_F(Catalog, ReturnsAtMostTheLimit) {
  EXPECT_EQ(matched("//mass", 4).size(), 4u);
  EXPECT_EQ(matched("/toys/*/*", 7).size(), 7u);
}

// Without a bound, n times `//` visits a tree of depth d in d^n ways.
TEST_F(Catalog, CostOfAPatternIsBounded) {
  NodeId at = toys;
  for (int i = 0; i < 60; i++) at = store.add_group(at, "deep");
  std::string pattern;
  for (int i = 0; i < 20; i++) pattern += "//*";
  EXPECT_EQ(matched(pattern + "/nothing"), Paths{});
  EXPECT_EQ(matched("/toys/bear//mass").size(), 3u);
}

TEST_F(Catalog, RejectsPatternsBeyondTheBudget) {
  for (int i = 0; i < 200; i++) store.add(Toy::table(), toys, fmt::format("aaaaaaaaaaaaaaaaaaaaaaaa{}", i), &toy);
  // The stars need more steps for one name than the whole budget.
  const std::string evil = "/toys/*a*a*a*a*a*a*a*b/mass";
  PatternBudget small{20000};
  const Result<std::vector<PropertyRef>> places = match_properties(store, evil, small);
  ASSERT_FALSE(places.ok());
  EXPECT_EQ(places.error(),
            "the pattern '" + evil + "' needs too much work; make it more specific, or send fewer at a time");
  EXPECT_TRUE(small.exceeded());
  // The budget is exceeded by a few names at most.
  EXPECT_GT(small.remaining, -30000);
  // Partial results are discarded.
  PatternBudget half{100 * PatternBudget::kStepsPerName};
  EXPECT_FALSE(match_properties(store, "/toys/*/mass", half).ok());
  // An exact path is free, and a cheap pattern fits in the remaining budget.
  PatternBudget left{20 * PatternBudget::kStepsPerName};
  EXPECT_TRUE(match_properties(store, "/toys/duck/mass", left).ok());
  EXPECT_EQ(left.remaining, 20 * PatternBudget::kStepsPerName);
  EXPECT_EQ(match_properties(store, "/toys/duck/part/*/mass", left)->size(), 2u);
  EXPECT_FALSE(match_properties(store, "/toys/*/part/*/mass", left).ok());
}

TEST_F(Catalog, FindsEachPropertyOnce) {
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
