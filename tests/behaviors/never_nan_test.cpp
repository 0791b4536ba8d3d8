// No value of any parameter makes a behaviour ask for what is no number: all the ends of all ranges, on parts that lie
// on each other, stand still, race, or are far out.
#include <cmath>

#include "behaviors/rig.h"

namespace limber {
namespace {

using namespace test;

// two bodies of four balls each, with joints and motors, in places that make trouble
struct Trouble : Rig {
  std::vector<Part*> parts;
  Trouble() {
    for (const char* name : {"one", "two"}) {
      Body& b = body(name);
      for (int i = 0; i < 4; i++) {
        Part& part = ball(b, {0.3 * i, 0, 0}, 0.001);
        if (i > 0) {
          Joint& joint = **b.add_joint("joint" + std::to_string(i), *parts.back(), part, JointType::spherical,
                                       part.pose().position, Vec3(0, 0, 1));
          Motor& motor = **b.add_motor(joint);
          set(motor.id(), "angular_active", {1, 1, 1});
          set(motor.id(), "angular_servo_active", {1, 0, 1});
          set(motor.id(), "angular_spring_active", {0, 1, 0});
        }
        parts.push_back(&part);
      }
    }
  }
  void place(int how) {
    const Vec3 at[] = {{0, 0, 0}, {1e6, -1e6, 1e6}, {1e-30, 0, 0}, {0, 0, 1e-3}};
    const Vec3 moves[] = {{0, 0, 0}, {1e4, 1e4, -1e4}, {1e-300, 0, 0}, {0, 1e-5, 0}};
    for (std::size_t i = 0; i < parts.size(); i++) {
      const std::size_t k = (i * static_cast<std::size_t>(how)) % 4;
      parts[i]->set_pose({at[k], quat_identity()});
      parts[i]->set_velocity(moves[k], moves[(k + 1) % 4]);
    }
  }
  void expect_numbers(const std::string& what) {
    for (Part* part : parts) {
      const Vec3 f = force(*part);
      const Vec3 t = torque(*part);
      EXPECT_TRUE(is_finite(f) && is_finite(t)) << what << " force " << f.x << " " << f.y << " " << f.z;
      clear(*part);
    }
    for (const auto& b : world.bodies()) {
      for (const auto& motor : b->motors()) {
        EXPECT_TRUE(is_finite(vec(motor->id(), "angular_servo_position"))) << what;
        EXPECT_TRUE(is_finite(vec(motor->id(), "angular_spring_rest_length"))) << what;
      }
    }
  }
};

double extreme(const Row& row, int which) {
  if (row.type == RowType::boolean) return 1;
  switch (which) {
    case 0:
      return row.min;
    case 1:
      return row.max;
    case 2:
      return 0;
    case 3:
      return 1e-300;
    default:
      return 1;
  }
}

TEST(NeverNan, AtTheEndsOfAllRanges) {
  Trouble s;
  std::mt19937 dice(3);
  for (const auto& type : s.world.behaviors().types().all()) {
    Body& body = *s.world.find_body("one");
    NodeId id;
    Behavior* single = nullptr;
    BehaviorGroup* group = nullptr;
    if (type->is_group) {
      group = &s.add_group(type->name);
      id = group->id();
    } else {
      single = &s.add(body, type->name);
      id = single->id();
    }
    const Table& table = s.store.table(id);
    for (int round = 0; round < 400; round++) {
      std::string what = type->name;
      for (const Row& row : table.rows()) {
        if (row.kind != RowKind::property) continue;
        std::vector<double> values;
        for (std::uint32_t i = 0; i < row.width; i++) values.push_back(extreme(row, static_cast<int>(dice() % 5)));
        s.set(id, row.name, values);
        what += " " + row.name + " " + std::to_string(values[0]);
      }
      s.place(static_cast<int>(dice() % 4));
      s.act();
      s.expect_numbers(what);
    }
    if (single != nullptr) s.world.behaviors().remove(*single);
    if (group != nullptr) s.world.behaviors().remove_group(*group);
  }
}

}  // namespace
}  // namespace limber
