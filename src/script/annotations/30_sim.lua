-- The world, and when a scene acts in it.

---The world. The top level of a scene describes what exists; callbacks act.
---@class sim
---@field alive boolean # read-only. Always true.
---@field bodies body_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field collision_groups string[] # Names of the 16 collision groups, in order of their bits; set at the top level.
---@field gears gear_list # read-only. Made by add_gear, in stream order.
---@rows sim
sim = {}

---A body from a URDF file.
---@param path string
---@param opts? urdf_opts
---@return body
function sim:load_urdf(path, opts) end

---@class urdf_opts: body_opts
---@field name? string # Left out: the robot's.
---@field fixed_base? boolean # Left out: as the mass of its root says.
---@field keep_fixed? boolean # default false. Links behind fixed joints stay parts of their own.
---@field motors? "servo"|"off" # default "servo".
---@field pose? table<string, number> # Joint = value, rad or m.
---@field package_path? string|string[] # Where package:// is looked for.

---An empty body.
---@param name string
---@param opts? body_opts
---@return body
function sim:add_body(name, opts) end

---Attaches a behaviour to several bodies, an instance each. What is written to the group goes to every member.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string
---@param opts? group_opts
---@return behavior_group
function sim:add_group_behavior(type, name, opts) end

---A group by its name.
---@param name string|behavior_group
---@return behavior_group
function sim:group_behavior(name) end

---Couples the own axes of two joints, of one body or of two, both ways: position of b = ratio * position of a + offset.
---@param joint_a joint # Revolute, continuous or prismatic.
---@param joint_b joint
---@param ratio number # Travel of b per travel of a; not 0.
---@param opts? gear_opts # `offset` left out: from the present positions.
---@return gear
function sim:add_gear(joint_a, joint_b, ratio, opts) end

---A gear by its name or number (-1: the last).
---@param key string|integer|gear
---@return gear
function sim:gear(key) end

---A body by its name or number (-1: the last). An error with the near names when there is none.
---@param key string|integer|body
---@return body
function sim:body(key) end

---A body by its name, or nil.
---@param name string
---@return body?
function sim:find_body(name) end

---A plane that never ends.
---@param name string
---@param normal? vec3like # default 0 0 1.
---@return shape
function sim:add_plane_shape(name, normal) end

---A ball.
---@param name string
---@param radius number # m
---@return shape
function sim:add_sphere_shape(name, radius) end

---A box.
---@param name string
---@param size vec3like # m, full edges
---@return shape
function sim:add_box_shape(name, size) end

---A cylinder, along z.
---@param name string
---@param radius number # m
---@param height number # m
---@return shape
function sim:add_cylinder_shape(name, radius, height) end

---A cylinder with round caps, along z.
---@param name string
---@param radius number # m
---@param height number # m, without the caps
---@return shape
function sim:add_capsule_shape(name, radius, height) end

---A cone, along z.
---@param name string
---@param radius number # m
---@param height number # m
---@return shape
function sim:add_cone_shape(name, radius, height) end

---@class mesh_opts
---@field scale? number|vec3like # default 1.
---@field max_vertices? integer # 4 .. 255, default 64 of a file, 255 of a list.

---The hull of a mesh file, or of points.
---@param name string
---@param source string|vec3like[]
---@param opts? mesh_opts
---@return shape
function sim:add_convex_mesh_shape(name, source, opts) end

---A shape made of others, by `shape:add_child`.
---@param name string
---@return shape
function sim:add_compound_shape(name) end

---At the start and after each reset.
---@param f fun()
function sim:on_start(f) end

---In each tick, before the physics.
---@param f fun(dt: number)
function sim:on_step(f) end

---When a part with `report_contacts` begins to touch: impulse in N·s, position in m.
---@param f fun(part: part, other: part, impulse: number, position: vec3)
function sim:on_contact(f) end

---Calls f each time the simulated time passes a multiple of `seconds`. A timer set in a callback continues unchanged after a save.
---@param seconds number
---@param f fun()
---@return timer
function sim:every(seconds, f) end

---Calls f once, `seconds` from now. A timer set in a callback continues after a save; one at the top level keeps its time.
---@param seconds number
---@param f fun()
---@return timer
function sim:after(seconds, f) end

---Once, at that simulated time.
---@param time number # s
---@param f fun()
---@return timer
function sim:at(time, f) end

---@action sim reset
function sim:reset() end

---@action sim panic
function sim:panic() end

---Text that is the same when the world is the same to the bit.
---@return string
function sim:state_hash() end

---@class timer
local timer_ = {}

---It does not come any more.
function timer_:cancel() end
