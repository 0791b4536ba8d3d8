// Every file of src/sim/behavior/builtin registers a type of its name, and every type has the documented properties.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/text.h"
#include "sim/behavior/behavior.h"
#include "sim/behavior/behavior_type.h"

namespace limber::sim {
namespace {

TEST(BuiltInBehaviors, HaveOneFileEach) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/src/sim/behavior/builtin")) {
    EXPECT_EQ(entry.path().extension(), ".cpp") << entry.path();
    files.insert(entry.path().stem().string());
  }
  const BehaviorTypes known;
  std::set<std::string> types;
  for (const auto& type : known.all()) types.insert(type->name);
  EXPECT_EQ(types, files);
  EXPECT_GE(types.size(), 12U);
}

TEST(BuiltInBehaviors, AreInAlphabeticalOrder) {
  const BehaviorTypes types;
  for (std::size_t i = 1; i < types.all().size(); i++) EXPECT_LT(types.all()[i - 1]->name, types.all()[i]->name);
}

TEST(BuiltInBehaviors, AreFullyDescribed) {
  const BehaviorTypes types;
  for (const auto& type : types.all()) {
    EXPECT_TRUE(type->is_built_in);
    EXPECT_GT(type->doc.size(), 20U) << type->name;
    EXPECT_EQ(type->doc.back(), '.') << type->name;
    EXPECT_EQ(type->table->path(), "/physics/body/<body>/behavior/<" + type->name + ">");
    EXPECT_EQ(type->is_group, type->group_table != nullptr) << type->name;
    const auto properties = type->table->properties();
    ASSERT_GT(properties.size(), kCommonBehaviorProperties + 1) << type->name;
    EXPECT_EQ(properties[0].name, "active");
    EXPECT_EQ(properties[0].initial[0], 1);
    EXPECT_EQ(properties[1].name, "time");
    EXPECT_EQ(properties[2].name, "remove");
    EXPECT_EQ(properties.back().name, "error") << "last, since it has no number";
    EXPECT_EQ(properties.back().type, PropertyType::text);
    for (const Property& property : properties) {
      EXPECT_GT(property.doc.size(), 5U) << type->name << " " << property.name;
      if (property.kind == PropertyKind::setting && property.type != PropertyType::boolean) {
        EXPECT_TRUE(std::isfinite(property.min) && std::isfinite(property.max)) << type->name << " " << property.name;
      }
    }
    if (type->group_table == nullptr) continue;
    // a group has no error of its own
    ASSERT_EQ(type->group_table->properties().size(), properties.size() - 1);
    for (std::size_t i = 0; i + 1 < properties.size(); i++) {
      EXPECT_EQ(type->group_table->property(static_cast<std::uint32_t>(i)).name, properties[i].name);
    }
  }
}

// The documented parameters, types and defaults.
struct Expected {
  const char* type;
  const char* property_name;
  std::vector<double> initial;
  const char* unit;
};

TEST(BuiltInBehaviors, HaveTheDocumentedParameters) {
  const std::vector<Expected> all = {
      {"force", "dir", {1, 0, 0}, ""},
      {"force", "amp", {0}, "N"},
      {"force", "max_amp", {1e4}, "N"},
      {"force", "app_interval", {1}, "ms"},
      {"torque", "torque", {0, 0, 0}, "N·m"},
      {"torque", "scale", {1}, ""},
      {"torque", "app_interval", {1}, "ms"},
      {"random_force", "min_dir", {-1, -1, -1}, ""},
      {"random_force", "max_dir", {1, 1, 1}, ""},
      {"random_force", "min_amp", {0}, "N"},
      {"random_force", "max_amp", {10}, "N"},
      {"random_force", "rand_interval", {1000}, "ms"},
      {"random_force", "app_interval", {1}, "ms"},
      {"random_torque", "min_torque", {-1, -1, -1}, "N·m"},
      {"random_torque", "max_torque", {1, 1, 1}, "N·m"},
      {"random_torque", "scale", {1}, ""},
      {"random_torque", "rand_interval", {1000}, "ms"},
      {"random_torque", "app_interval", {1}, "ms"},
      {"rotation_target", "target", {0, 0, 0}, "rad"},
      {"rotation_target", "speed", {0.1}, "rad"},
      {"rotation_target", "app_interval", {1}, "ms"},
      {"random_rotation_target", "min_target", {0, 0, 0}, "rad"},
      {"random_rotation_target", "max_target", {0, 0, 0}, "rad"},
      {"random_rotation_target", "speed", {0.1}, "rad"},
      {"random_rotation_target", "rand_interval", {1000}, "ms"},
      {"random_rotation_target", "app_interval", {1}, "ms"},
      {"rotation_target_oscil", "target1", {0, 0, -1}, "rad"},
      {"rotation_target_oscil", "target2", {0, 0, 1}, "rad"},
      {"rotation_target_oscil", "speed", {0.1}, "rad"},
      {"rotation_target_oscil", "oscil_interval", {1000}, "ms"},
      {"rotation_target_oscil", "app_interval", {1}, "ms"},
      {"speed", "speed", {1}, "m/s"},
      {"speed", "amount", {1}, "N·s/m"},
      {"target_attraction", "target_pos", {0, 0, 0}, "m"},
      {"target_attraction", "min_dist", {0}, "m"},
      {"target_attraction", "max_dist", {10}, "m"},
      {"target_attraction", "min_amp", {0}, "N"},
      {"target_attraction", "max_amp", {10}, "N"},
      {"target_attraction", "app_interval", {1}, "ms"},
      {"volume", "max_dist", {1}, "m"},
      {"volume", "min_amp", {0}, "N"},
      {"volume", "max_amp", {10}, "N"},
      {"volume", "app_interval", {1}, "ms"},
      {"cohesion", "min_dist", {0}, "m"},
      {"cohesion", "max_dist", {10}, "m"},
      {"cohesion", "amount", {1}, "N"},
      {"alignment", "min_dist", {0}, "m"},
      {"alignment", "max_dist", {10}, "m"},
      {"alignment", "linear_amount", {1}, "N·s/m"},
      {"alignment", "angular_amount", {1}, "N·m·s/rad"},
      {"alignment", "amount", {1}, ""},
      {"separation", "min_dist", {0}, "m"},
      {"separation", "max_dist", {1}, "m"},
      {"separation", "amount", {1}, "N"},
      {"mocap_attraction", "source", {1}, ""},
      {"mocap_attraction", "joint", {1}, ""},
      {"mocap_attraction", "to_joint", {0}, ""},
      {"mocap_attraction", "stiffness", {20}, "N/m"},
      {"mocap_attraction", "damping", {2}, "N·s/m"},
      {"mocap_attraction", "max_force", {50}, "N"},
      {"mocap_attraction", "max_dist", {100}, "m"},
      {"mocap_attraction", "radius", {0}, "m"},
      {"mocap_attraction", "turns", {1}, ""},
      {"mocap_attraction", "phase", {0}, "rad"},
      {"mocap_target", "source", {1}, ""},
      {"mocap_target", "joint", {1}, ""},
      {"mocap_target", "measure", {3}, ""},
      {"mocap_target", "gain", {1}, ""},
      {"mocap_target", "offset", {0}, ""},
      {"mocap_target", "low", {-1e4}, ""},
      {"mocap_target", "high", {1e4}, ""},
      {"mocap_target", "smoothing", {0.05}, "s"},
      {"mocap_target", "max_speed", {5}, ""},
      {"mocap_body", "source", {1}, ""},
  };
  const BehaviorTypes types;
  std::size_t count = 0;
  for (const auto& type : types.all()) count += type->table->properties().size() - kCommonBehaviorProperties - 1;
  EXPECT_EQ(count, all.size());
  for (const Expected& expected : all) {
    const Property* property = types.find(expected.type)->table->find(expected.property_name);
    ASSERT_NE(property, nullptr) << expected.type << " " << expected.property_name;
    EXPECT_EQ(std::vector<double>(property->initial.begin(), property->initial.begin() + property->width),
              expected.initial)
        << expected.type << " " << expected.property_name;
    EXPECT_EQ(property->unit, expected.unit) << expected.type << " " << expected.property_name;
    EXPECT_EQ(property->kind, PropertyKind::setting);
  }
}

}  // namespace
}  // namespace limber::sim
