-- The world, and the callbacks of a scene.

---The world. The top level of a scene describes the objects; callbacks act on them.
---@class sim
---@field alive boolean # read-only. Always true.
---@field bodies body_list # read-only. In stream order; call it to iterate over those that match a pattern.
---@field collision_groups string[] # Names of the 16 collision groups, in order of their bits; set at the top level.
---@field gears gear_list # read-only. Created by add_gear, in stream order.
---@properties sim
sim = {}

---Loads a body from a URDF file, or from an MJCF file of MuJoCo (.xml).
---@param path string
---@param opts? urdf_opts
---@return body
function sim:load_urdf(path, opts) end

---@class urdf_opts: body_opts
---@field name? string # default: the robot's name.
---@field fixed_base? boolean # default: true if the root link has no mass; MJCF: if it has no free joint.
---@field keep_fixed? boolean # default false. Keep links with fixed joints as separate parts.
---@field motors? "servo"|"off" # default "servo"; MJCF: "off" for joints without an actuator.
---@field pose? table<string, number> # Joint = value, rad or m.
---@field package_path? string|string[] # Search path for package://.
---@field root? string # MJCF: the top-level body to load, or "world" for all; default: the first that moves.

---Creates an empty body.
---@param name string
---@param opts? body_opts
---@return body
function sim:add_body(name, opts) end

---Attaches a behavior to several bodies, one instance per body. Values set on the group are set on all members.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string
---@param opts? group_opts
---@return behavior_group
function sim:add_group_behavior(type, name, opts) end

---Returns a group by name.
---@param name string|behavior_group
---@return behavior_group
function sim:group_behavior(name) end

---Couples the own axes of two joints of one or two bodies in both directions: position of b = ratio * position of a +
---offset.
---@param joint_a joint # Revolute, continuous or prismatic.
---@param joint_b joint
---@param ratio number # Travel of b per travel of a; not 0.
---@param opts? gear_opts # `offset`: default from the current positions.
---@return gear
function sim:add_gear(joint_a, joint_b, ratio, opts) end

---Returns a gear by name or number (-1: the last).
---@param key string|integer|gear
---@return gear
function sim:gear(key) end

---Returns a body by name or number (-1: the last). If there is none, the error suggests similar names.
---@param key string|integer|body
---@return body
function sim:body(key) end

---Returns a body by name, or nil.
---@param name string
---@return body?
function sim:find_body(name) end

---Creates an infinite plane.
---@param name string
---@param normal? vec3like # default 0 0 1.
---@return shape
function sim:add_plane_shape(name, normal) end

---Creates a sphere.
---@param name string
---@param radius number # m
---@return shape
function sim:add_sphere_shape(name, radius) end

---Creates a box.
---@param name string
---@param size vec3like # m, full edge lengths
---@return shape
function sim:add_box_shape(name, size) end

---Creates a cylinder along z.
---@param name string
---@param radius number # m
---@param height number # m
---@return shape
function sim:add_cylinder_shape(name, radius, height) end

---Creates a capsule (a cylinder with hemispherical caps) along z.
---@param name string
---@param radius number # m
---@param height number # m, without the caps
---@return shape
function sim:add_capsule_shape(name, radius, height) end

---Creates a cone along z.
---@param name string
---@param radius number # m
---@param height number # m
---@return shape
function sim:add_cone_shape(name, radius, height) end

---@class mesh_opts
---@field scale? number|vec3like # default 1.
---@field max_vertices? integer # 4 .. 255, default 64 for a file, 255 for a list.

---Creates the convex hull of a mesh file, or of points.
---@param name string
---@param source string|vec3like[]
---@param opts? mesh_opts
---@return shape
function sim:add_convex_mesh_shape(name, source, opts) end

---Creates a shape that consists of other shapes; see `shape:add_child`.
---@param name string
---@return shape
function sim:add_compound_shape(name) end

---Calls f at the start and after each reset.
---@param f fun()
function sim:on_start(f) end

---Calls f in each tick, before the physics step.
---@param f fun(dt: number)
function sim:on_step(f) end

---Calls f when a part with `report_contacts` begins to touch another: impulse in N·s, position in m.
---@param f fun(part: part, other: part, impulse: number, position: vec3)
function sim:on_contact(f) end

---Calls f each time the simulation time passes a multiple of `seconds`. Timers set in callbacks survive a reload.
---@param seconds number
---@param f fun()
---@return timer
function sim:every(seconds, f) end

---Calls f once, `seconds` from now. Timers set in callbacks survive a reload; one set at the top level keeps its due
---time.
---@param seconds number
---@param f fun()
---@return timer
function sim:after(seconds, f) end

---Calls f once, at that simulation time.
---@param time number # s
---@param f fun()
---@return timer
function sim:at(time, f) end

---@action sim reset
function sim:reset() end

---@action sim panic
function sim:panic() end

---Returns a hash of the world's exact state; equal states have equal hashes.
---@return string
function sim:state_hash() end

---@class timer
local timer_ = {}

---Cancels the timer.
function timer_:cancel() end
