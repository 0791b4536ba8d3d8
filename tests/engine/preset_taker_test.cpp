// Planning in slices yields the same presets as planning at once, for all structural changes.
#include "engine/presets/capturer.h"

#include <algorithm>
#include <set>
#include <span>

#include <fmt/ranges.h>

#include "engine/rig.h"
#include "properties/catalog.h"
#include "sim/world/part.h"
#include "support/skip.h"

namespace limber::engine::test {
namespace {

std::size_t node_count(const Store& store) {
  std::size_t count = 0;
  store.walk(store.root(), [&](NodeId) { count++; });
  return count;
}

// Calls prepare() until it is ready; returns the number of calls.
std::size_t prepare(PresetCapturer& taker, const Store& store) {
  std::size_t calls = 0;
  for (; !taker.ready(store) && calls < 100000; calls++) taker.prepare(store);
  return calls;
}

void expect_same(const Preset& a, const Preset& b) {
  EXPECT_EQ(a.values, b.values);
  EXPECT_TRUE(*a.schema == *b.schema);
}

struct PresetCapturerTest : testing::Test {
  Rig rig;
  void add_bodies(int count) {
    sim::Shape& shape = **rig.world.shapes().add(fmt::format("shape{}", bodies_added), ball());
    for (int i = 0; i < count; i++) {
      sim::Body& body = **rig.world.add_body(fmt::format("more{}", bodies_added++));
      ASSERT_TRUE(body.add_part("tip", shape, i % 2, Pose{}).ok());
    }
    rig.world.flush();
  }
  std::shared_ptr<const Preset> capture_new(const PresetSelection& selection = {}) const {
    return *PresetCapturer().capture(rig.store, "all", selection);
  }
  int bodies_added = 0;
};

TEST_F(PresetCapturerTest, ListsNodesInTheOrderOfTheTree) {
  std::vector<std::string> tree, preset;
  rig.store.walk(rig.store.root(), [&](NodeId id) {
    const auto& properties = rig.store.table(id).properties();
    if (std::ranges::any_of(properties, [](const Property& property) {
          return property.kind == PropertyKind::setting && property.stored();
        }))
      tree.push_back(rig.store.path(id));
  });
  const auto captured = capture_new();
  for (std::uint32_t i = 0; i < captured->schema->nodes().size(); i++) {
    if (captured->schema->layout(captured->schema->nodes()[i]) != nullptr) preset.push_back(captured->schema->path(i));
  }
  EXPECT_GT(tree.size(), 15u);
  EXPECT_EQ(preset, tree);
}

TEST_F(PresetCapturerTest, PlansAtOnceAfterLargeChanges) {
  PresetCapturer capturer;
  EXPECT_EQ(prepare(capturer, rig.store), 1u);
  add_bodies(700);
  EXPECT_FALSE(capturer.ready(rig.store));
  EXPECT_EQ(prepare(capturer, rig.store), 1u);
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
  add_bodies(300);
  EXPECT_EQ(prepare(capturer, rig.store), 1u);
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
  add_bodies(1);
  EXPECT_GT(prepare(capturer, rig.store), static_cast<std::size_t>(PresetCapturer::kSettleCalls))
      << "small changes are planned later";
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
}

TEST_F(PresetCapturerTest, PlansInSlices) {
  PresetCapturer capturer;
  capturer.prepare(rig.store);
  capturer.forget_store();
  EXPECT_EQ(prepare(capturer, rig.store), PresetCapturer::kSettleCalls + 1u) << "less than a slice";
  add_bodies(700);
  capturer.prepare(rig.store);
  capturer.forget_store();
  const std::size_t slices = node_count(rig.store) / PresetCapturer::kNodesPerCall + 1;
  EXPECT_GT(slices, 4u);
  EXPECT_EQ(prepare(capturer, rig.store), PresetCapturer::kSettleCalls + slices);
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
}

TEST_F(PresetCapturerTest, IncludesNodesAddedWhilePlanning) {
  PresetCapturer capturer;
  add_bodies(700);
  capturer.prepare(rig.store);
  capturer.forget_store();
  for (int i = 0; i < PresetCapturer::kSettleCalls + 3; i++) capturer.prepare(rig.store);
  add_bodies(3);
  capturer.prepare(rig.store);
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
  rig.world.remove_body(*rig.world.find_body("more1"));
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
}

TEST_F(PresetCapturerTest, CaptureFinishesPlanning) {
  PresetCapturer capturer;
  add_bodies(700);
  capturer.prepare(rig.store);
  capturer.forget_store();
  for (int i = 0; i < PresetCapturer::kSettleCalls + 2; i++) capturer.prepare(rig.store);
  EXPECT_FALSE(capturer.ready(rig.store));
  const PresetSelection part{{"/physics/body/more*//*"}, {}, true, false};
  expect_same(**capturer.capture(rig.store, "some", part), *capture_new(part));
  expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
  EXPECT_TRUE(capturer.ready(rig.store));
}

// the properties of a preset with their values, as text
std::set<std::string> properties_of(const Preset& preset) {
  std::set<std::string> texts;
  for (std::uint32_t i = 0; i < preset.schema->nodes().size(); i++) {
    const PresetSchema::Node& node = preset.schema->nodes()[i];
    const PresetLayout* const layout = preset.schema->layout(node);
    for (std::size_t k = 0; layout != nullptr && k < layout->properties.size(); k++) {
      const double* const values = preset.values.data() + node.offset + layout->offsets[k];
      texts.insert(fmt::format("{}/{} {}", preset.schema->path(i), layout->properties[k].name,
                               fmt::join(std::span(values, layout->properties[k].width), " ")));
    }
  }
  return texts;
}

// The same from the store: reference implementation that looks up each pattern.
std::set<std::string> properties_of(const Store& store, const PresetSelection& selection) {
  std::set<std::string> texts;
  const auto add = [&](NodeId id, const Property& property) {
    const bool state = property.kind == PropertyKind::state && &store.table(id) == &sim::Part::table();
    const bool pose = property.name == "position" || property.name == "rotation";
    if (property.kind != PropertyKind::setting && !(state && (pose ? selection.poses : selection.velocities))) return;
    if (!property.stored() ||
        (property.validate != nullptr && !property.validate(store.object(id), store.values(id, property))))
      return;
    texts.insert(fmt::format("{}/{} {}", store.path(id), property.name,
                             fmt::join(std::span(store.values(id, property), property.width), " ")));
  };
  std::vector<NodeId> parts;
  for (const std::string& pattern : selection.include) {
    PatternBudget budget;
    const auto refs = match_properties(store, pattern, budget);
    for (const PropertyRef& ref : *refs) {
      store.walk(ref.node, [&](NodeId id) {
        if (ref.property != nullptr && id != ref.node) return;
        if (ref.property != nullptr)
          add(id, *ref.property);
        else
          for (const Property& property : store.table(id).properties()) add(id, property);
        if (&store.table(id) == &sim::Part::table()) parts.push_back(id);
      });
    }
  }
  // state of parts: of the selected parts, or of all if no part was selected
  if (parts.empty()) {
    store.walk(store.root(), [&](NodeId id) {
      if (&store.table(id) == &sim::Part::table()) parts.push_back(id);
    });
  }
  for (const NodeId part : parts) {
    for (const Property& property : sim::Part::table().properties()) {
      if (property.kind == PropertyKind::state) add(part, property);
    }
  }
  return texts;
}

TEST_F(PresetCapturerTest, ASelectionHasTheMatchesOfItsPatterns) {
  add_bodies(25);
  const std::vector<PresetSelection> choices = {
      {{"/physics/body/*/part/*/*"}, {}, false, false},
      {{"/physics/body/*/part/*/{mass,friction}"}, {}, false, false},
      {{"/physics/body/more1*//*"}, {}, true, false},
      {{"/physics/body/more[12]//friction", "/physics/sim/gravity"}, {}, false, true},
      {{"/physics/body/more3"}, {}, true, true},
      {{"/physics/body/more3/part/tip/mass", "/physics/body/more4/part/tip/mass"}, {}, false, false},
      {{"/visuals"}, {}, true, false},
      {{"//friction"}, {}, false, false},
      {{"/Physics/BODY/more?/Part/tip/restitution"}, {}, false, false},
      {{"/physics/body"}, {}, false, true},
      {{"/physics", "/visuals"}, {}, true, true},
  };
  for (const PresetSelection& choice : choices) {
    SCOPED_TRACE(choice.include.front());
    PresetCapturer capturer;
    const auto captured = capturer.capture(rig.store, "some", choice);
    ASSERT_TRUE(captured.ok()) << captured.error();
    EXPECT_EQ(properties_of(**captured), properties_of(rig.store, choice));
    expect_same(**capturer.capture(rig.store, "again", choice), **captured);
  }
  // an empty selection includes all properties, here with the state of parts
  const auto all = *PresetCapturer().capture(rig.store, "all", {{}, {}, true, true});
  EXPECT_EQ(properties_of(*all), properties_of(rig.store, {{"/clock", "/physics", "/visuals"}, {}, true, true}));
}

TEST_F(PresetCapturerTest, ReportsASelectionWithoutMatch) {
  const auto fault = [&](const char* pattern) {
    const auto captured = PresetCapturer().capture(rig.store, "some", {{pattern}, {}, false, false});
    return captured.ok() ? "" : captured.error();
  };
  EXPECT_EQ(fault("/physics/body/*/part/*/position"), "'/physics/body/*/part/*/position' matches no property");
  EXPECT_EQ(fault("/physics/body/missing*"), "'/physics/body/missing*' matches no property");
  EXPECT_EQ(fault("/physics/bodi").find("there is no 'bodi' in /physics"), 0u) << fault("/physics/bodi");
  EXPECT_EQ(fault("body"), "'body' is not an address: it must begin with /");
  // each pattern costs little work, but not all together
  const auto many =
      PresetCapturer().capture(rig.store, "many", {std::vector<std::string>(100000, "//mass"), {}, false, false});
  ASSERT_FALSE(many.ok());
  EXPECT_EQ(many.error().find("the pattern '//mass' needs too much work"), 0u) << many.error();
}

// With a buffer that was allocated ahead, also when it is too small for the added nodes.
TEST_F(PresetCapturerTest, LargePresetsAreTheSameInAPreparedBuffer) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  PresetCapturer capturer;
  for (const int more : {7000, 1, 1500}) {
    add_bodies(more);
    for (int i = 0; i < 3; i++) capturer.prepare(rig.store);
    const auto captured = *capturer.capture(rig.store, "all", {});
    EXPECT_GT(captured->values.size(), PresetCapturer::kMinBufferValues);
    expect_same(*captured, *capture_new());
  }
}

// Unchanged subtrees are copied from the previous plan, whatever was added, removed or moved next to them.
TEST_F(PresetCapturerTest, ReusesUnchangedSubtrees) {
  PresetCapturer capturer;
  add_bodies(20);
  capturer.finish_planning(rig.store);
  const auto expect_new_plan = [&](const char* what) {
    EXPECT_FALSE(capturer.ready(rig.store)) << what;
    SCOPED_TRACE(what);
    expect_same(**capturer.capture(rig.store, "all", {}), *capture_new());
    EXPECT_TRUE(capturer.ready(rig.store)) << what;
  };
  add_bodies(1);
  expect_new_plan("one was added");
  rig.world.remove_body(*rig.world.find_body("more0"));
  expect_new_plan("the first was removed");
  rig.world.remove_body(*rig.world.find_body("more20"));
  rig.world.remove_body(*rig.world.find_body("more7"));
  add_bodies(2);
  expect_new_plan("others in the same slots");
  const NodeId body = rig.world.find_body("more9")->id();
  const std::size_t place = rig.store.hide(body);
  expect_new_plan("one is hidden");
  rig.store.show(body, place);
  expect_new_plan("it is shown again");
  const NodeId first[] = {rig.world.find_body("more15")->id(), body};
  rig.store.order_children(rig.store.parent(body), first);
  expect_new_plan("another order");
  rig.store.bump_structure_version();
  expect_new_plan("nothing changed");
  const PresetSelection part{{"/physics/body/more1*//*"}, {}, false, false};
  expect_same(**capturer.capture(rig.store, "some", part), *capture_new(part));
}

}  // namespace
}  // namespace limber::engine::test
