// A property that is added to a table gets its path and its legacy message, in every form, without more code.
#include "engine/rig.h"

namespace limber::engine::test {
namespace {

using Kind = Outcome::Kind;
using Values = std::vector<double>;

// the properties of parts and one more
const PropertyTable& parts_with_a_toy() {
  static const PropertyTable table = [] {
    const PropertyTable& own = sim::Part::table();
    std::vector<Property> list(own.properties().begin(), own.properties().end());
    list.push_back(properties::number("toy_strength", "N", 2, 0, 10, "A force."));
    return PropertyTable(own.name(), own.path(), own.legacy_prefix(), std::move(list));
  }();
  return table;
}

// two bodies with nodes of that table as parts and nothing else: the world never steps
struct ToyRig {
  Store store;
  sim::World world{store};
  const PropertyTable* classes[1] = {&parts_with_a_toy()};
  MessageDispatcher dispatcher{world, nullptr, classes};

  ToyRig() {
    for (const char* name : {"arm", "1"}) {
      const sim::Body& body = **world.add_body(name);
      const NodeId group = store.child(body.id(), "part");
      for (const char* part : {"base", "tip"}) store.add(parts_with_a_toy(), group, part, nullptr);
    }
  }
  template <class... A>
  Outcome send(std::string address, A&&... args) {
    dispatcher.begin_pass();
    return dispatcher.execute(message(std::move(address), std::forward<A>(args)...));
  }
  // of arm/base, arm/tip, 1/base, 1/tip
  Values toys() const {
    Values all;
    for (const char* part : {"arm/part/base", "arm/part/tip", "1/part/base", "1/part/tip"}) {
      const Result<PropertyRef> ref = find_property(store, fmt::format("/physics/body/{}/toy_strength", part));
      double value = -1;
      if (ref && ref->property != nullptr) store.get(ref->node, *ref->property, &value);
      all.push_back(value);
    }
    return all;
  }
};

TEST(AddedProperty, HasAPath) {
  ToyRig rig;
  EXPECT_EQ(rig.toys(), (Values{2, 2, 2, 2}));
  EXPECT_EQ(rig.send("/physics/body/arm/part/tip/toy_strength", 3).kind, Kind::applied);
  EXPECT_EQ(rig.send("/physics/body/*/part/base/ToyStrength", "4.5").kind, Kind::applied);
  EXPECT_EQ(rig.toys(), (Values{4.5, 3, 4.5, 2}));
  const Outcome asked = rig.send("/get", "/physics/body/arm/part/tip/toy_strength");
  ASSERT_EQ(asked.answers.size(), 1u);
  EXPECT_EQ(asked.answers[0].args.at(0).number, 3);
}

TEST(AddedProperty, HasALegacyMessageInEveryForm) {
  struct Form {
    std::vector<Arg> names;
    Values toys;
  };
  const Form forms[] = {
      {{}, {7, 7, 7, 7}},
      {{arg("arm")}, {7, 7, 2, 2}},
      {{arg(1)}, {2, 2, 7, 7}},
      {{arg("tip")}, {2, 7, 2, 7}},
      {{arg("arm"), arg("tip")}, {2, 7, 2, 2}},
      {{arg("a*"), arg("{base,tip}")}, {7, 7, 2, 2}},
  };
  for (const char* address : {"/physics/part/toystrength", "/physics/part/toy_strength"}) {
    for (const Form& form : forms) {
      ToyRig rig;
      Message m{address, form.names};
      m.args.push_back(arg(7));
      EXPECT_EQ(rig.dispatcher.execute(m).kind, Kind::applied) << address;
      EXPECT_EQ(rig.toys(), form.toys) << address;
    }
  }
}

TEST(AddedProperty, ClampsAndRejectsAsItsTableSpecifies) {
  ToyRig rig;
  EXPECT_EQ(MessageDispatcher::legacy_address(parts_with_a_toy(), parts_with_a_toy().at("toy_strength")),
            "/physics/part/toystrength");
  const Outcome clamped = rig.send("/physics/part/toystrength", "arm", 11);
  EXPECT_NE(clamped.clamped, nullptr);
  EXPECT_EQ(rig.toys(), (Values{10, 10, 2, 2}));
  EXPECT_EQ(rig.send("/physics/part/toystrength", "arm", 1, 2).kind, Kind::rejected);
  EXPECT_EQ(rig.send("/physics/part/toystrength", "arm", "tipp", 1).error,
            "no part 'tipp' in 'arm'; did you mean 'tip'?");
  const Outcome near = rig.send("/physics/part/toystrenght", 1);
  EXPECT_EQ(near.kind, Kind::unknown);
  EXPECT_NE(near.error.find("did you mean '/physics/part/toystrength'?"), std::string::npos) << near.error;
  EXPECT_EQ(rig.toys(), (Values{10, 10, 2, 2}));
}

}  // namespace
}  // namespace limber::engine::test
