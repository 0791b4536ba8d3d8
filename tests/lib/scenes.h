// Scenes and tools for the tests of liblimber.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lib/limber.h"

namespace limber::lib::test {

/// An arm of two hinged rods with motors above a floor, and a script that uses random numbers and trigonometry.
inline constexpr const char* kArm = R"(
  sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
  local arm = sim:add_body("arm")
  local rod = sim:add_box_shape("rod", vec3(0.05, 0.05, 0.4))
  arm:add_part("base", rod, { position = vec3(0, 0, 0.7), motion = "static" })
  arm:add_part("upper", rod, { position = vec3(0, 0, 1.1), mass = 1 })
  arm:add_part("lower", rod, { position = vec3(0, 0, 1.5), mass = 1, report_contacts = true })
  for name, at in pairs({ shoulder = 0.9, elbow = 1.3 }) do
    local parts = name == "shoulder" and { "base", "upper" } or { "upper", "lower" }
    local joint = arm:add_joint(name, parts[1], parts[2], { position = vec3(0, 0, at), axis = vec3(0, 1, 0) })
    joint.angular_lower_limit, joint.angular_upper_limit = -3, 3
    arm:add_motor(joint, { max_angular_force = 50 })
  end
  sim:on_step(function() arm:part("lower"):apply_force(vec3(math.random() - 0.5, math.sin(sim.time), 0)) end)
)";

struct LogLines {
  std::vector<std::string> lines;
  static void add(void* context, limber_log_level, const char* text) {
    static_cast<LogLines*>(context)->lines.emplace_back(text);
  }
  std::string all() const {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }
};

/// A simulation of a text that the destructor destroys.
class TestSim {
 public:
  explicit TestSim(const char* text, std::uint64_t seed = 1) {
    limber_options options = LIMBER_OPTIONS;
    options.text = text;
    options.seed = &seed;
    options.log = &LogLines::add;
    options.log_context = &log;
    EXPECT_EQ(limber_create(&options, &sim), LIMBER_OK) << limber_last_error();
  }
  ~TestSim() { limber_destroy(sim); }
  TestSim(const TestSim&) = delete;
  TestSim& operator=(const TestSim&) = delete;

  void step(std::uint64_t ticks) const { EXPECT_EQ(limber_step(sim, ticks), LIMBER_OK) << limber_last_error(); }
  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    EXPECT_EQ(limber_hash(sim, &hash), LIMBER_OK);
    return hash;
  }
  limber_property* find(const char* address) const {
    limber_property* property = nullptr;
    EXPECT_EQ(limber_find(sim, address, &property), LIMBER_OK) << limber_last_error();
    return property;
  }
  std::vector<double> read(limber_property* property) const {
    std::vector<double> values(limber_count(property) * limber_width(property));
    EXPECT_EQ(limber_read(property, values.data(), values.size()), LIMBER_OK) << limber_last_error();
    return values;
  }

  LogLines log;
  limber_sim* sim = nullptr;
};

}  // namespace limber::lib::test
