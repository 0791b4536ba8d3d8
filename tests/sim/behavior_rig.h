// BehaviorRig: a stage that knows two types of behaviour, a probe that writes down what happens to it and a group's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/behavior_list.h"
#include "sim/stage.h"

namespace limber::test {

/// Writes into `diary`: "start b/name", "step b/name"; errs when its parameter `broken` is set.
class Probe : public Behavior {
 public:
  enum Parameter : std::uint32_t { amount, broken, way, beat };
  static inline std::vector<std::string> diary;

  void start() override { diary.push_back("start " + label()); }
  void step(double) override {
    diary.push_back("step " + label());
    if (due(beat)) beats++;
    if (flag(broken)) fail({"it is broken", "probe.lua", 7});
    last = random().uniform();
  }
  void take_over(Behavior& before) override { beats = 100 + static_cast<Probe&>(before).beats; }
  std::string label() const { return body().name() + "/" + name(); }

  int beats = 0;
  double last = 0;
};

inline std::vector<Row> probe_rows() {
  return {rows::number("amount", "N", 2, -10, 10, "A number."), rows::boolean("broken", false, "Whether it errs."),
          rows::vec3("way", "m", {1, 2, 3}, -100, 100, "A vector."),
          rows::number("beat", "ms", 100, 0, 1e6, "An interval.")};
}

struct BehaviorRig : Stage {
  BehaviorRig() {
    Probe::diary.clear();
    EXPECT_TRUE(types().add(BehaviorType::of<Probe>("probe", "A probe.", BehaviorTargets::any, probe_rows())).ok());
    EXPECT_TRUE(types().add(BehaviorType::of_group<Probe>("probe_group", "Probes.", probe_rows())).ok());
  }
  BehaviorTypes& types() { return world.behaviors().types(); }
  BehaviorList& list() { return world.behaviors(); }

  /// A body of balls with these names, a joint between each and the one before.
  Body& chain(const std::string& name, const std::vector<std::string>& parts, double first_mass = 1) {
    Body& b = body(name);
    if (ball_ == nullptr) ball_ = &shape(sphere_model(0.05));
    for (std::size_t i = 0; i < parts.size(); i++) {
      const double x = static_cast<double>(i);
      Part& part = **b.add_part(parts[i], *ball_, i == 0 ? first_mass : 1, {{x, 0, 0}, quat_identity()});
      if (i == 0) continue;
      Joint& joint =
          **b.add_joint("to_" + parts[i], *b.parts()[i - 1], part, JointType::revolute, {x, 0, 0}, {0, 1, 0});
      EXPECT_TRUE(b.add_motor(joint).ok());
    }
    return b;
  }
  Probe& probe(Body& body, const std::string& name = "probe", BehaviorSetup setup = {}) {
    Result<Behavior*> made = list().add(body, "probe", name, std::move(setup));
    EXPECT_TRUE(made.ok()) << made.error();
    return static_cast<Probe&>(**made);
  }
  BehaviorGroup& group(const std::string& name, GroupSetup setup = {}) {
    Result<BehaviorGroup*> made = list().add_group("probe_group", name, std::move(setup));
    EXPECT_TRUE(made.ok()) << made.error();
    return **made;
  }
  std::string refusal(Body& body, const std::string& type, const std::string& name, BehaviorSetup setup = {}) {
    const Result<Behavior*> made = list().add(body, type, name, std::move(setup));
    return made ? "" : made.error();
  }
  std::string group_refusal(const std::string& type, const std::string& name, GroupSetup setup = {}) {
    const Result<BehaviorGroup*> made = list().add_group(type, name, std::move(setup));
    return made ? "" : made.error();
  }
  static std::vector<std::string> take_diary() { return std::exchange(Probe::diary, {}); }

 private:
  Shape* ball_ = nullptr;
};

using Words = std::vector<std::string>;

inline BehaviorSetup on_parts(Words words) {
  BehaviorSetup setup;
  setup.parts = Selection(std::move(words));
  return setup;
}

inline GroupSetup group_of(Words bodies, Words parts) {
  GroupSetup setup;
  setup.bodies = Selection(std::move(bodies));
  setup.parts = Selection(std::move(parts));
  return setup;
}

template <class List>
Words names_in(const List& things) {
  Words names;
  for (const auto& thing : things) names.push_back(thing->name());
  return names;
}

}  // namespace limber::test
