// A scene with every class of object, every type of joint and every kind of parameter.
#pragma once

namespace limber::engine::test {

inline constexpr const char* kEverything = R"(
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local shape = sim:add_box_shape("brick", vec3(0.1, 0.1, 0.2))
local body = sim:add_body("arm", {})
body:add_part("base", shape, { mass = 0, position = vec3(0, 0, 1) })
for i, kind in ipairs { "revolute", "prismatic", "spherical", "planar", "floating" } do
  body:add_part("part_" .. kind, shape, { position = vec3(0.3 * i, 0, 1) })
  local joint = body:add_joint(kind, i == 1 and "base" or body.parts[i].name, "part_" .. kind,
    { type = kind, position = vec3(0.3 * i, 0, 1) })
  body:add_motor(joint)
end
sim:add_gear(body:joint("revolute"), body:joint("prismatic"), 0.1, { name = "rack" })
body:add_tendon("cord", { points = { { "base", 0, 0, 0.1 }, { "part_revolute", 0, 0, 0.1 } }, rest_length = 50 })
sim:add_mocap("dancer", { source = "osc", joints = { "hips", "head" }, bones = { { "hips", "head" } } })
body:add_part("hat", shape, { position = vec3(2, 0, 1) })
body:add_joint("weld", "part_floating", "hat", { type = "fixed" })
local hat = body:part("hat")
hat:add_imu("imu", { position = vec3(0, 0, 0.1) })
hat:add_range_finder("eye", { direction = vec3(0, 0, -1) })
hat:add_zone("zone", { sees_static = true })
body:part("base"):add_touch("skin")
body:add_behavior("random_force", "wind", { parts = "hat" })
sim:add_body("free"):add_part("free", shape, { position = vec3(0, 4, 2) })
body:copy("twin", { position = vec3(0, 2, 1) })
sim:add_group_behavior("cohesion", "swarm", { bodies = { "arm", "twin" } })
sim:add_route("link", { from = "/physics/sim/timestep", to = "/physics/sim/speed" })
params {
  { "wind", 0, min = 0, max = 10, unit = "N", doc = "A number." },
  { "where", vec3(0, 0, 1), min = -1, max = 2, doc = "A vec3." },
  { "lively", true, doc = "A boolean." },
  { "style", "calm", choices = { "calm", "wild" }, doc = "A choice." },
}
)";

}  // namespace limber::engine::test
