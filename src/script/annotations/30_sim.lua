-- The world, and the callbacks of a scene.

---@page world

---The world. The top level of a scene describes the objects; callbacks act on them.
---@class sim
---@field alive boolean # read-only. Always true.
---@field bodies body_list # read-only. All bodies, in stream order; call it to iterate over those that match a pattern.
---@field clock clock # read-only. Musical time: beats, bars and tempo.
---@field collision_groups string[] # Names of the 16 collision groups, in order of their bits; set at the top level.
---@field fixtures fixture_list # read-only. All lighting fixtures, in the order of their creation; call it to iterate over those that match a pattern.
---@field gears gear_list # read-only. All gears, in stream order; call it to iterate over those that match a pattern.
---@field mocaps mocap_list # read-only. All sources of motion capture, in the order of their creation.
---@field routes route_list # read-only. All routes, in stream order; call it to iterate over those that match a pattern.
---@properties sim
---@error sim.gravty = vec3() --> sim has no property 'gravty'; did you mean 'gravity'?
---@error sim.gravity = 9.81 --> sim: 'gravity' takes a vec3, not 9.81
---@error sim.time = 0 --> sim: 'time' is a readout: it can be read, not set
---@see sim:add_body, sim:on_step
---@example world
sim = {}

---Loads a body from a URDF file, or from an MJCF file of MuJoCo (.xml).
---@param path string # Searched in the program's data, the folder of the scene and the folders above it.
---@param opts? urdf_opts # Such as `name` and `position`.
---@return body
---@error sim:load_urdf("urdf/arm7.urdf") --> there is no file 'urdf/arm7.urdf'; looked for …
---@error sim:load_urdf("urdf/arm6.urdf", { name = "second", pose = { elbow = 1 } }) --> … pose: 'arm6' has no movable joint 'elbow'; there are: joint_1, joint_2, joint_3, joint_4, joint_5, joint_6
---@see sim:add_body, body:link
---@example robot
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
---@param name string # A name of your choice, unique in the world.
---@param opts? body_opts # Such as `position`.
---@return body
---@error sim:add_body("arm") --> there is a body 'arm' already; names are unique
---@error sim:add_body() --> add_body: the name takes text, not nothing
---@see sim:load_urdf, body:add_part, body:copy
---@example body
function sim:add_body(name, opts) end

---@page behaviors

---Attaches a behavior to several bodies, one instance per body. Values set on the group are set on all members.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string # A name of your choice, unique among groups.
---@param opts? group_opts # Such as `bodies`, and the type's parameters.
---@return behavior_group
---@error sim:add_group_behavior("random_force", "gusts") --> 'random_force' acts on one body: attach it with body:add_behavior
---@see behavior_group, body:add_behavior
---@example swarm
function sim:add_group_behavior(type, name, opts) end

---Returns a group by name.
---@param name string|behavior_group # The name of the group.
---@return behavior_group
---@error sim:group_behavior("swarm") --> sim has no group behavior 'swarm'; none exist
---@example swarm
function sim:group_behavior(name) end

---@page joints

---Couples the own axes of two joints of one or two bodies in both directions: position of b = ratio * position of a +
---offset.
---@param joint_a joint # Revolute, continuous or prismatic.
---@param joint_b joint
---@param ratio number # Travel of b per travel of a; not 0.
---@param opts? gear_opts # `offset`: default from the current positions.
---@return gear
---@error sim:add_gear(arm:joint(1), arm:joint(1), 2) --> gear 'joint_1_joint_1': needs two different joints
---@error sim:add_gear(arm:joint(1), arm:joint(2), 0) --> gear 'joint_1_joint_2': the ratio must be -1000000 .. 1000000 and not 0, got 0
---@see gear
---@example gears
function sim:add_gear(joint_a, joint_b, ratio, opts) end

---Returns a gear by name or number (-1: the last).
---@param key string|integer|gear # Its name, its number from 1, or -1 for the last.
---@return gear
---@error sim:gear("drive") --> there is no gear 'drive'; none exist
---@see sim.gears
---@example gears
function sim:gear(key) end

---@page world

---Returns a body by name or number (-1: the last). If there is none, the error suggests similar names.
---@param key string|integer|body # Its name, its number from 1, or -1 for the last.
---@return body
---@error sim:body("amr") --> there is no body 'amr'; did you mean 'arm'?
---@see sim:find_body, sim.bodies
---@example finding
function sim:body(key) end

---Returns a body by name, or nil.
---@param name string
---@return body?
---@see sim:body
---@example finding
function sim:find_body(name) end

---@page shapes

---Creates an infinite plane.
---@param name string # A name of your choice, unique among shapes.
---@param normal? vec3like # default 0 0 1.
---@return shape
---@see look.floor
---@example shapes
function sim:add_plane_shape(name, normal) end

---Creates a sphere.
---@param name string # A name of your choice, unique among shapes.
---@param radius number # m
---@return shape
---@error sim:add_sphere_shape("dot", -1) --> shape 'dot': a sphere needs a radius of 0.0001 .. 10000 m, not -1
---@error sim:add_sphere_shape("ball", 0.1) --> there is a shape 'ball' already; names are unique
---@see body:add_part
---@example shapes
function sim:add_sphere_shape(name, radius) end

---Creates a box.
---@param name string # A name of your choice, unique among shapes.
---@param size vec3like # m, full edge lengths
---@return shape
---@error sim:add_box_shape("cube", 0.1) --> add_box_shape: the size (full edges) takes a vec3, not 0.1
---@see body:add_part
---@example shapes
function sim:add_box_shape(name, size) end

---Creates an ellipsoid.
---@param name string # A name of your choice, unique among shapes.
---@param radii vec3like # m, half the lengths of its axes
---@return shape
---@error sim:add_ellipsoid_shape("egg", 0.1) --> add_ellipsoid_shape: the radii takes a vec3, not 0.1
---@error sim:add_ellipsoid_shape("egg", vec3(0.1, 0, 0.1)) --> shape 'egg': an ellipsoid needs a radius of 0.0001 .. 10000 m, not 0
---@see body:add_part
---@example shapes
function sim:add_ellipsoid_shape(name, radii) end

---Creates a cylinder along z.
---@param name string # A name of your choice, unique among shapes.
---@param radius number # m
---@param height number # m
---@return shape
---@error sim:add_cylinder_shape("rod", 0.1) --> add_cylinder_shape: the height takes a number, not nothing
---@see body:add_part
---@example shapes
function sim:add_cylinder_shape(name, radius, height) end

---Creates a capsule (a cylinder with hemispherical caps) along z.
---@param name string # A name of your choice, unique among shapes.
---@param radius number # m
---@param height number # m, without the caps
---@return shape
---@see body:add_part
---@example shapes
function sim:add_capsule_shape(name, radius, height) end

---Creates a cone along z.
---@param name string # A name of your choice, unique among shapes.
---@param radius number # m
---@param height number # m
---@return shape
---@see body:add_part
---@example shapes
function sim:add_cone_shape(name, radius, height) end

---@class mesh_opts
---@field scale? number|vec3like # default 1.
---@field max_vertices? integer # 4 .. 255 for each hull, default 64 for a file, 255 for a list.
---@field concave? boolean # true decomposes the mesh of a file into convex pieces, which leave its hollows free.

---Creates the convex hull of a mesh file, or of points. An OBJ or glTF file of several
---objects gives one hull for each.
---@param name string # A name of your choice, unique among shapes.
---@param source string|vec3like[] # A file (STL, OBJ, DAE, PLY or glTF), or a list of points, m.
---@param opts? mesh_opts
---@return shape
---@error sim:add_convex_mesh_shape("hull", "no.stl") --> there is no file 'no.stl'; looked for …
---@see sim:add_compound_shape
---@example mesh
function sim:add_convex_mesh_shape(name, source, opts) end

---@class mesh_shape_opts
---@field scale? number|vec3like # default 1.

---Creates the surface of a mesh file, which static and kinematic parts collide with, hollows included. It has no inside:
---both of its sides hold others. Call it at the top level of the scene.
---@param name string # A name of your choice, unique among shapes.
---@param file string # STL, OBJ, DAE, PLY or glTF.
---@param opts? mesh_shape_opts
---@return shape
---@error sim:add_mesh_shape("valley", "no.stl") --> there is no file 'no.stl'; looked for …
---@see sim:add_convex_mesh_shape, sim:add_heightfield_shape
---@example mesh_surface
function sim:add_mesh_shape(name, file, opts) end

---@class heightfield_opts
---@field size vec3like|number[] # m, its width along x and length along y.
---@field rows? integer # 2 .. 1024, number of heights along y.
---@field columns? integer # 2 .. 1024, number of heights along x.
---@field heights? number[]|fun(x: number, y: number): number # m, in rows from -y to +y, each from -x to +x; or a function of the place.
---@field image? string # A PNG or JPEG file of at most 1024 × 1024 pixels instead of rows, columns and heights; its upper side is +y.
---@field height? number # m, height of white in the image; black is at 0.

---Creates terrain from heights on a grid, centered on the part's position, for static and kinematic parts. Call it at
---the top level of the scene.
---@param name string # A name of your choice, unique among shapes.
---@param opts heightfield_opts
---@return shape
---@error sim:add_heightfield_shape("hill", { size = { 1, 1 }, rows = 1, columns = 2, heights = {} }) --> add_heightfield_shape: rows is 2 .. 1024, not 1
---@error sim:add_heightfield_shape("hill", { size = { 1, 1 }, rows = 2, columns = 2, heights = { 1 } }) --> add_heightfield_shape: 2 rows and 2 columns need 4 heights, not 1
---@see sim:add_plane_shape, sim:add_mesh_shape
---@example terrain
function sim:add_heightfield_shape(name, opts) end

---Creates a shape that consists of other shapes; see `shape:add_child`.
---@param name string # A name of your choice, unique among shapes.
---@return shape
---@see shape:add_child
---@example compound
function sim:add_compound_shape(name) end

---@page sensors

---Returns the first part on the straight line between two points, or nil. It sees the exact shapes in their present
---poses; a line that starts in a part does not see that part.
---@param from vec3like # m, world.
---@param to vec3like # m, world.
---@param opts? ray_opts
---@return ray_hit?
---@error sim:ray(vec3(0, 0, 0 / 0), vec3()) --> sim:ray: from takes a finite number, not nan
---@see sim:rays, part:add_range_finder
---@example rays
function sim:ray(from, to, opts) end

---Returns the distances of the first parts on the lines from a point to each of the targets; `math.huge` without a part.
---@param from vec3like # m, world.
---@param targets vec3like[] # m, world.
---@param opts? rays_opts
---@return number[]
---@error sim:rays(vec3(), 3) --> sim:rays: targets is a list of vec3s, not 3
---@see sim:ray
---@example rays
function sim:rays(from, targets, opts) end

---Returns the parts whose surface is at most `radius` away from a point, in stream order, and a list of their distances
---(negative: the point is inside the part).
---@param center vec3like # m, world.
---@param radius number # m, at least 0.
---@param opts? ray_opts
---@return part[]
---@return number[]
---@error sim:overlap_sphere(vec3(), -1) --> sim:overlap_sphere: the radius must be at least 0, not -1
---@see part:add_zone
---@example rays
function sim:overlap_sphere(center, radius, opts) end

---@class ray_opts
---@field ignore? body|part # A body or part that is not seen.

---@class rays_opts: ray_opts
---@field into? number[] # A table for the result, which is then not created in each call.

---A point at which a line meets a part.
---@class ray_hit
---@field part part # The part.
---@field position vec3 # The point in m, world.
---@field normal vec3 # Normal of the surface there, world, unit length, outwards.
---@field distance number # Distance from the start of the line in m.
---@see sim:ray
---@example rays

---@page events

---Calls f at the start and after each reset.
---@param f fun() # The function to call.
---@error sim:on_start(3) --> sim:on_start takes a function, not 3
---@see sim:on_step
---@example callbacks
function sim:on_start(f) end

---Calls f in each tick, before the physics step.
---@param f fun(dt: number) # The function to call; dt is the time step in s.
---@see sim:every, sim.timestep
---@example callbacks
function sim:on_step(f) end

---Calls f on each beat of `sim.clock`, before the physics step. With `every`: at each multiple of that many beats, such
---as 0.25 for sixteenth notes, or 4. Not more often than once in a tick.
---@param f fun(beat: number) # The function to call; beat is the beat that was reached.
---@param every? number # Beats, from 1/64 to 4096. Default 1.
---@error sim:on_beat(print, 0) --> sim:on_beat takes 1/64 to 4096 beats, not 0
---@see sim.clock, sim:every
---@example clock
function sim:on_beat(f, every) end

---Calls f when a part with `report_contacts` begins to touch another: impulse in N·s, position in m.
---@param f fun(part: part, other: part, impulse: number, position: vec3) # The function to call.
---@see part.report_contacts, sim:on_contact_stay, sim:on_contact_end
---@example contacts
function sim:on_contact(f) end

---Calls f in each tick in which a part with `report_contacts` still touches another: normal impulse of the last tick in
---N·s, position in m.
---@param f fun(part: part, other: part, impulse: number, position: vec3) # The function to call.
---@error sim:on_contact_stay(3) --> sim:on_contact_stay takes a function, not 3
---@see sim:on_contact
---@example contact_points
function sim:on_contact_stay(f) end

---Calls f when a part with `report_contacts` no longer touches another; the impulse is 0, the position the last one.
---@param f fun(part: part, other: part, impulse: number, position: vec3) # The function to call.
---@error sim:on_contact_end(3) --> sim:on_contact_end takes a function, not 3
---@see sim:on_contact
---@example contact_points
function sim:on_contact_end(f) end

---Calls f when a part enters a zone.
---@param f fun(zone: zone, part: part) # The function to call.
---@error sim:on_zone_enter(3) --> sim:on_zone_enter takes a function, not 3
---@see part:add_zone, sim:on_zone_leave
---@example zone
function sim:on_zone_enter(f) end

---Calls f when a part leaves a zone.
---@param f fun(zone: zone, part: part) # The function to call.
---@error sim:on_zone_leave(3) --> sim:on_zone_leave takes a function, not 3
---@see sim:on_zone_enter
---@example zone
function sim:on_zone_leave(f) end

---Calls f each time the simulation time passes a multiple of `seconds`. Timers set in callbacks survive a reload.
---@param seconds number # s, simulation time. Above 0.
---@param f fun() # The function to call.
---@return timer
---@error sim:every(0, print) --> sim:every takes seconds above 0, not 0
---@see timer:cancel, sim:after
---@example timers
function sim:every(seconds, f) end

---Calls f once, `seconds` from now. Timers set in callbacks survive a reload; one set at the top level keeps its due
---time.
---@param seconds number # s, simulation time.
---@param f fun() # The function to call.
---@return timer
---@see sim:at, sim:every
---@example timers
function sim:after(seconds, f) end

---Calls f once, at that simulation time.
---@param time number # s
---@param f fun() # The function to call.
---@return timer
---@see sim:after
---@example timers
function sim:at(time, f) end

---@action sim reset
---@error sim:reset() --> sim:reset acts on the running scene; at the top level use sim:on_start(function() … end)
---@see body:reset, state
---@example restarting
function sim:reset() end

---@action sim panic
---@error sim:panic() --> sim:panic acts on the running scene; at the top level use sim:on_start(function() … end)
---@see sim.panicked, sim.panic_motors
---@example panic
function sim:panic() end

---@page world

---Returns a hash of the world's exact state; equal states have equal hashes.
---@return string
---@see body:state_hash
---@example hashes
function sim:state_hash() end

---@page events

---A timer of sim:every, sim:after or sim:at.
---@class timer
---@see sim:every
---@example timers
local timer_ = {}

---Cancels the timer.
---@example timers
function timer_:cancel() end
