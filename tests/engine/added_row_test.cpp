// A row that joins a table: its path and its message in the seed's style are there, in every form, without more code.
#include "engine/rig.h"

namespace limber::engine_test {
namespace {

using Kind = Outcome::Kind;
using Values = std::vector<double>;

// the parts' table as it is, and one row more
const Table& parts_with_a_toy() {
  static const Table table = [] {
    const Table& own = Part::table();
    std::vector<Row> list(own.rows().begin(), own.rows().end());
    list.push_back(rows::number("toy_strength", "N", 2, 0, 10, "What a child pulls with."));
    return Table(own.name(), own.path(), own.seed(), std::move(list));
  }();
  return table;
}

// two bodies whose parts are nodes of that table and nothing else: the world never steps
struct ToyRig {
  Store store;
  World world{store};
  const Table* classes[1] = {&parts_with_a_toy()};
  Dispatch dispatch{world, nullptr, classes};

  ToyRig() {
    for (const char* name : {"arm", "1"}) {
      const Body& body = **world.add_body(name);
      const NodeId group = store.child(body.id(), "part");
      for (const char* part : {"base", "tip"}) store.add(parts_with_a_toy(), group, part, nullptr);
    }
  }
  template <class... A>
  Outcome send(std::string address, A&&... args) {
    dispatch.begin_tick();
    return dispatch.execute(message(std::move(address), std::forward<A>(args)...));
  }
  // of arm/base, arm/tip, 1/base, 1/tip
  Values toys() const {
    Values all;
    for (const char* part : {"arm/part/base", "arm/part/tip", "1/part/base", "1/part/tip"}) {
      const Result<Place> place = find_place(store, fmt::format("/physics/body/{}/toy_strength", part));
      double value = -1;
      if (place && place->row != nullptr) store.get(place->node, *place->row, &value);
      all.push_back(value);
    }
    return all;
  }
};

TEST(AddedRow, HasItsPath) {
  ToyRig rig;
  EXPECT_EQ(rig.toys(), (Values{2, 2, 2, 2}));
  EXPECT_EQ(rig.send("/physics/body/arm/part/tip/toy_strength", 3).kind, Kind::applied);
  EXPECT_EQ(rig.send("/physics/body/*/part/base/ToyStrength", "4.5").kind, Kind::applied);
  EXPECT_EQ(rig.toys(), (Values{4.5, 3, 4.5, 2}));
  const Outcome asked = rig.send("/get", "/physics/body/arm/part/tip/toy_strength");
  ASSERT_EQ(asked.answers.size(), 1u);
  EXPECT_EQ(asked.answers[0].args.at(0).number, 3);
}

TEST(AddedRow, HasItsMessageInEveryForm) {
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
      EXPECT_EQ(rig.dispatch.execute(m).kind, Kind::applied) << address;
      EXPECT_EQ(rig.toys(), form.toys) << address;
    }
  }
}

TEST(AddedRow, ClampsRefusesAndIsNamedAsItsTableSays) {
  ToyRig rig;
  EXPECT_EQ(Dispatch::seed_address(parts_with_a_toy(), parts_with_a_toy().at("toy_strength")),
            "/physics/part/toystrength");
  const Outcome clamped = rig.send("/physics/part/toystrength", "arm", 11);
  EXPECT_NE(clamped.clamped, nullptr);
  EXPECT_EQ(rig.toys(), (Values{10, 10, 2, 2}));
  EXPECT_EQ(rig.send("/physics/part/toystrength", "arm", 1, 2).kind, Kind::refused);
  EXPECT_EQ(rig.send("/physics/part/toystrength", "arm", "tipp", 1).error,
            "no part 'tipp' in 'arm'; did you mean 'tip'?");
  const Outcome near = rig.send("/physics/part/toystrenght", 1);
  EXPECT_EQ(near.kind, Kind::unknown);
  EXPECT_NE(near.error.find("did you mean '/physics/part/toystrength'?"), std::string::npos) << near.error;
  EXPECT_EQ(rig.toys(), (Values{10, 10, 2, 2}));
}

}  // namespace
}  // namespace limber::engine_test
