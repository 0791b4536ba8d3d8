// A scene in which every type of behavior is active, for tests of all types.
#pragma once

namespace limber::engine::test {

inline constexpr const char* kEveryBehavior = R"(
sim.gravity = vec3(0, 0, 0)
local shape = sim:add_sphere_shape("ball", 0.1)
for i = 1, 6 do
  local body = sim:add_body("body" .. i)
  for k = 1, 4 do body:add_part("part" .. k, shape, { position = vec3(0.5 * k, i, 0.1 * i * k) }) end
  for k = 2, 4 do body:add_motor(body:add_joint("joint" .. k, k - 1, k, { type = "spherical" })) end
  for _, motor in ipairs(body.motors) do motor.angular_active, motor.angular_servo_active = true, true end
  body:add_behavior("force", "force", { amp = 0.2, app_interval = 30 })
  body:add_behavior("torque", "torque", { torque = vec3(0, 0.01, 0), parts = "part1" })
  body:add_behavior("random_force", "random_force", { rand_interval = 100, max_amp = 1 })
  body:add_behavior("random_torque", "random_torque", { rand_interval = 70, scale = 0.01 })
  body:add_behavior("rotation_target_oscil", "rotation_target_oscil", { joints = "joint2", oscil_interval = 90 })
  body:add_behavior("rotation_target", "rotation_target", { joints = "joint2", target = vec3(0.2, 0.3, -0.4) })
  body:add_behavior("random_rotation_target", "random_rotation_target",
    { motors = "joint[34]", min_target = vec3(-0.3, -0.3, -0.3), max_target = vec3(0.3, 0.3, 0.3) })
  body:add_behavior("speed", "speed", { amount = 0.5 })
  body:add_behavior("target_attraction", "target_attraction", { target_pos = vec3(1, 3, 0), max_amp = 1 })
  body:add_behavior("volume", "volume", { parts = { "part1", "part3", "part2", "part4" } })
end
sim:add_group_behavior("cohesion", "cohesion", { max_dist = 2, amount = 0.5 })
sim:add_group_behavior("alignment", "alignment", { max_dist = 2, angular_amount = 0.01 })
sim:add_group_behavior("separation", "separation", { bodies = "body[1-4]", parts = "part[12]" })
)";

}  // namespace limber::engine::test
