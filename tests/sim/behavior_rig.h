// BehaviorRig: a world with two behavior types, one for single bodies and one for groups, that log their calls.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/behavior/behavior_list.h"
#include "sim/stage.h"

namespace limber::sim::test {

/// Logs its calls to `calls`: "start b/name", "step b/name"; fails if its parameter `broken` is set.
class Probe : public Behavior {
 public:
  enum Parameter : std::uint32_t { amount, broken, way, beat };
  static inline std::vector<std::string> calls;

  void start() override { calls.push_back("start " + label()); }
  void step(double) override {
    calls.push_back("step " + label());
    if (interval_elapsed(beat)) elapsed_count++;
    if (flag(broken)) fail({"it is broken", "probe.lua", 7});
    last = random().uniform();
  }
  void adopt_state(Behavior& previous) override { elapsed_count = 100 + static_cast<Probe&>(previous).elapsed_count; }
  std::string label() const { return body().name() + "/" + name(); }

  int elapsed_count = 0;
  double last = 0;
};

inline std::vector<Property> probe_properties() {
  return {properties::number("amount", "N", 2, -10, 10, "A number."),
          properties::boolean("broken", false, "Whether it errs."),
          properties::vec3("way", "m", {1, 2, 3}, -100, 100, "A vector."),
          properties::number("beat", "ms", 100, 0, 1e6, "An interval.")};
}

struct BehaviorRig : WorldFixture {
  BehaviorRig() {
    Probe::calls.clear();
    EXPECT_TRUE(
        types().add(BehaviorType::create<Probe>("probe", "A probe.", BehaviorTargets::any, probe_properties())).ok());
    EXPECT_TRUE(types().add(BehaviorType::create_group<Probe>("probe_group", "Probes.", probe_properties())).ok());
  }
  BehaviorTypes& types() { return world.behaviors().types(); }
  BehaviorList& list() { return world.behaviors(); }

  /// A body of balls with these names, each jointed to the previous one.
  Body& chain(const std::string& name, const std::vector<std::string>& parts, double first_mass = 1) {
    Body& b = body(name);
    if (ball_ == nullptr) ball_ = &shape(sphere_model(0.05));
    for (std::size_t i = 0; i < parts.size(); i++) {
      const double x = static_cast<double>(i);
      Part& part = **b.add_part(parts[i], *ball_, i == 0 ? first_mass : 1, {{x, 0, 0}, quat_identity()});
      if (i == 0) continue;
      Joint& joint =
          **b.add_joint("to_" + parts[i], *b.parts()[i - 1], part, model::JointType::revolute, {x, 0, 0}, {0, 1, 0});
      EXPECT_TRUE(b.add_motor(joint).ok());
    }
    return b;
  }
  Probe& probe(Body& body, const std::string& name = "probe", BehaviorSetup setup = {}) {
    Result<Behavior*> added = list().add(body, "probe", name, std::move(setup));
    EXPECT_TRUE(added.ok()) << added.error();
    return static_cast<Probe&>(**added);
  }
  BehaviorGroup& group(const std::string& name, GroupSetup setup = {}) {
    Result<BehaviorGroup*> added = list().add_group("probe_group", name, std::move(setup));
    EXPECT_TRUE(added.ok()) << added.error();
    return **added;
  }
  std::string add_error(Body& body, const std::string& type, const std::string& name, BehaviorSetup setup = {}) {
    const Result<Behavior*> added = list().add(body, type, name, std::move(setup));
    return added ? "" : added.error();
  }
  std::string add_group_error(const std::string& type, const std::string& name, GroupSetup setup = {}) {
    const Result<BehaviorGroup*> added = list().add_group(type, name, std::move(setup));
    return added ? "" : added.error();
  }
  static std::vector<std::string> consume_calls() { return std::exchange(Probe::calls, {}); }

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
Words names_in(const List& objects) {
  Words names;
  for (const auto& object : objects) names.push_back(object->name());
  return names;
}

}  // namespace limber::sim::test
