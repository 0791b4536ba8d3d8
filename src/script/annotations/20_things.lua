-- Bodies and their components. Objects can be compared and used as table keys.

---@page bodies

---A named set of parts, joints and motors.
---@class body
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists; any other use of a removed object is an error.
---@field root part # read-only. The first part.
---@field parts part_list # read-only. Its parts, in stream order; call it to iterate over those that match a pattern.
---@field joints joint_list # read-only. Its joints, in stream order; call it to iterate over those that match a pattern.
---@field motors motor_list # read-only. Its motors, in stream order; call it to iterate over those that match a pattern.
---@field sensors sensor_list # read-only. Its sensors, in the order of their creation.
---@field tendons tendon_list # read-only. Its tendons, in the order of their creation.
---@field behaviors behavior_list # read-only. Its behaviors, in the order in which they run.
---@field excluded_pairs part[][] # read-only. Pairs of parts that are excluded from collision: `{ { a, b }, … }`.
---@properties body
---@error body.wieght = 3 --> body 'body' has no property 'wieght'; there are: alive, angular_momentum, angular_velocity, asleep, behaviors, can_sleep, center_of_mass, enabled …
---@error body.name = "other" --> body 'body': 'name' can be read, not set
---@see sim:add_body, sim:load_urdf, part
---@example body
local body_ = {}

---@class body_opts
---@opts body

---Adds a part with that shape. The pose is in world coordinates; default: the origin.
---@param name string # A name of your choice, unique in the body.
---@param shape shape|string # A shape, or its name.
---@param opts? part_opts # `mass` 0: static.
---@return part
---@error body:add_part("tip", "no shape") --> there is no shape 'no shape'; there are: arm6.base, arm6.link_1, arm6.block_1, arm6.link_2, arm6.block_2, arm6.link_3, arm6.tip, arm6.tip.2 …
---@error body:add_part("tip", shape, { mass = -1 }) --> add_part: mass must not be negative (0: a part that never moves)
---@error body:add_part("tip", shape, { wieght = 1 }) --> add_part: opts has no 'wieght'; there are: mass, position, rotation, angular_damping, angular_velocity, collision_group, collision_mask, friction …
---@see part, sim:add_sphere_shape, part_opts
---@example body
function body_:add_part(name, shape, opts) end

---Adds a joint between two parts. Their current pose is its zero position; its own axis is unlimited until limits are
---set.
---@param name string # A name of your choice, unique in the body.
---@param parent part|string|integer # A part, its name or its number.
---@param child part|string|integer # A part, its name or its number.
---@param opts? joint_opts # Such as `position`, `axis` and limits.
---@return joint
---@error body:add_joint("pin", "ball", "ball") --> joint 'body/pin': parent and child must be different parts
---@error body:add_joint("pin", "ball", "tail") --> body 'body' has no part 'tail'; there are: ball, cube
---@error body:add_joint("pin", "ball", "cube", { type = "hinge" }) --> joint 'body/pin': there is no joint type 'hinge'; there are: revolute, prismatic, spherical, planar, floating, fixed
---@see joint, body:add_motor
---@example joints
function body_:add_joint(name, parent, child, opts) end

---Adds a motor to a joint, with the joint's name; initially a servo that holds the position.
---@param joint joint|string|integer # A joint, its name or its number.
---@param opts? motor_opts # Such as `mode` and `target`.
---@return motor
---@error body:add_motor("knee") --> body 'body' has no joint 'knee'; none exist
---@error arm:add_motor("joint_1") --> joint 'arm/joint_1' has a motor already
---@see motor
---@example body
function body_:add_motor(joint, opts) end

---Returns a part by name or number (-1: the last). If there is none, the error suggests similar names.
---@param key string|integer|part # Its name, its number from 1, or -1 for the last.
---@return part
---@error body:part("tail") --> body 'body' has no part 'tail'; there are: ball, cube
---@error body:part(9) --> body 'body' has 2 parts; there is no 9
---@see body.parts
---@example body
function body_:part(key) end

---Returns a joint by name or number (-1: the last).
---@param key string|integer|joint # Its name, its number from 1, or -1 for the last.
---@return joint
---@error arm:joint("joint_9") --> body 'arm' has no joint 'joint_9'; did you mean 'joint_1'?
---@see body.joints
---@example body
function body_:joint(key) end

---@page behaviors

---Attaches a behavior: a built-in type, or a file of behaviors_lua/.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string # A name of your choice, unique in the body.
---@param opts? behavior_opts # Targets (default: all), `active`, and the type's parameters.
---@return behavior
---@error arm:add_behavior("windd", "wind") --> there is no behavior type 'windd'; …
---@error arm:add_behavior("random_force", "wind", { parts = "hand" }) --> body 'arm' has no part 'hand'; there are: base, link_1, block_1, link_2, block_2, link_3, tip
---@see behavior, sim:add_group_behavior
---@example wind
function body_:add_behavior(type, name, opts) end

---Returns a behavior by name or number (-1: the last).
---@param key string|integer|behavior # Its name, its number from 1, or -1 for the last.
---@return behavior
---@error arm:behavior("wind") --> body 'arm' has no behavior 'wind'; none exist
---@see body.behaviors
---@example wind
function body_:behavior(key) end

---@page bodies

---Returns a motor by name or number (-1: the last).
---@param key string|integer|motor # Its name, its number from 1, or -1 for the last.
---@return motor
---@error arm:motor("joint_9") --> body 'arm' has no motor 'joint_9'; did you mean 'joint_1'?
---@see body.motors
---@example body
function body_:motor(key) end

---Returns a link of the URDF file, including merged ones.
---@param name string # The name of the link in the file.
---@return link
---@error arm:link("tipp") --> body 'arm' has no link 'tipp'; did you mean 'tip'?
---@see link
---@example robot
function body_:link(name) end

---Returns the lowest and the highest coordinates of the body's collision shapes, or of its visuals if it has none: a
---box along the world's axes. nil if it has neither. Planes don't count.
---@return vec3? # m, world: the lowest coordinates.
---@return vec3? # m, world: the highest coordinates.
---@see body.position, sim:load_urdf
---@example bounds
function body_:bounds() end

---Creates a copy of the body as it has been described so far.
---@param name string # The name of the copy, unique in the world.
---@param opts? body_opts # Such as `position`.
---@return body
---@error body:copy("arm") --> there is a body 'arm' already; names are unique
---@see sim:add_body
---@example copies
function body_:copy(name, opts) end

---Excludes two parts of the body from collision with each other.
---@param a part|string|integer # A part, its name or its number.
---@param b part|string|integer # A part, its name or its number.
---@error body:exclude_pair("ball", "ball") --> body 'body': a pair needs two different parts, not 'ball' twice
---@see body:include_pair, body.excluded_pairs, part.collision_mask
---@example excluded_pairs
function body_:exclude_pair(a, b) end

---Enables collision of two parts that was excluded by exclude_pair or by an overlap at the home pose.
---@param a part|string|integer # A part, its name or its number.
---@param b part|string|integer # A part, its name or its number.
---@see body:exclude_pair
---@example excluded_pairs
function body_:include_pair(a, b) end

---@action body reset
---@error body:reset() --> body 'body':reset acts on the running scene; at the top level use sim:on_start(function() … end)
---@see sim:reset, body.enabled
---@example removing
function body_:reset() end

---@action body remove
---@error body:remove() --> body 'body':remove acts on the running scene; at the top level use sim:on_start(function() … end)
---@see body.alive
---@example removing
function body_:remove() end

---Returns a hash of the body's exact state; equal states have equal hashes.
---@return string
---@see sim:state_hash
---@example hashes
function body_:state_hash() end

---@page parts

---A rigid part of a body.
---@class part
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field shape shape # read-only. The geometry, which other parts may share.
---@properties part
---@error body:part(1).mass = "heavy" --> part 'body/ball': 'mass' takes a number, not 'heavy'
---@error body:part(1).motion = "kinetic" --> part 'body/ball': 'motion' can't be 'kinetic'; did you mean 'kinematic'?
---@see body:add_part, shape
---@example materials
---@example collision_groups
---@example platform
---@example conveyor
---@example copies
local part_ = {}

---@class part_opts
---@opts part

---@action part apply_force
---@param force vec3like # N, world.
---@param at? vec3like # m, world; default: the center of mass.
---@error body:part(1):apply_force(vec3(0, 0, 1)) --> part 'body/ball':apply_force acts on the running scene; at the top level use sim:on_start(function() … end)
---@see part:apply_impulse, part:apply_torque
---@example forces
function part_:apply_force(force, at) end

---@action part apply_impulse
---@param impulse vec3like # N·s, world.
---@param at? vec3like # m, world; default: the center of mass.
---@error body:part(1):apply_impulse(vec3(0, 0, 1)) --> part 'body/ball':apply_impulse acts on the running scene; at the top level use sim:on_start(function() … end)
---@see part:apply_force
---@example forces
function part_:apply_impulse(impulse, at) end

---@action part apply_torque
---@param torque vec3like # N·m, world axes.
---@error body:part(1):apply_torque(vec3(0, 0, 1)) --> part 'body/ball':apply_torque acts on the running scene; at the top level use sim:on_start(function() … end)
---@see part:apply_force
---@example forces
function part_:apply_torque(torque) end

---@page joints

---A connection of two parts. Its own axis is z of the joint's frame.
---@class joint
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field type "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # read-only. Its type.
---@field body body # read-only. The body that it belongs to.
---@field parent part # read-only. The part in front of the joint, nearer to the root.
---@field child part # read-only. The part behind the joint.
---@field motor? motor # read-only. nil if it has none.
---@properties joint
---@error arm:joint(1).value = 1 --> joint 'arm/joint_1': 'value' is a readout: it can be read, not set
---@see body:add_joint, motor, sim:add_gear
---@example joints
---@example ball_limits
local joint_ = {}

---@class joint_opts
---@field type? "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # default "revolute".
---@field position? vec3like # m, world; default: the child's.
---@field axis? vec3like # world, default 0 0 1.
---@opts joint

---@page motors

---Drives a joint. Properties with three axes accept a vec3, or one number for the own axis (booleans: for all axes).
---@class motor
---@field name string # read-only. The joint's.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field joint joint # read-only. The joint that it drives.
---@properties motor
---@error arm:motor(1).mode = "servos" --> motor 'arm/joint_1': 'mode' can't be 'servos'; did you mean 'servo'?
---@error arm:motor(1).angular_sevro_position = 1 --> motor 'arm/joint_1' has no property 'angular_sevro_position'; did you mean 'angular_servo_position'?
---@error arm:motor(1).target = "up" --> motor 'arm/joint_1': 'target' takes a number, not 'up'
---@see body:add_motor, joint, joint.value
---@example servo
---@example spin
---@example spring
---@example motor_axes
---@example torque
local motor_ = {}

---@class motor_opts
---@opts motor

---@page joints

---Couples two joints in both directions: position of b = ratio * position of a + offset. Created by sim:add_gear.
---@class gear
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists; it is removed with the bodies of its joints.
---@field joint_a joint # read-only. The first joint.
---@field joint_b joint # read-only. The second joint.
---@properties gear
---@see sim:add_gear
---@example gears
local gear_ = {}

---@action gear remove
---@example gears
function gear_:remove() end

---@class gear_opts
---@field name? string # default: the names of both joints.
---@opts gear

---@page shapes

---Geometry of parts for rendering and collision.
---@class shape
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@properties shape
---@see rgb(), visuals:shape, sim:add_sphere_shape
---@example materials_of_shapes
local shape_ = {}

---Adds a shape to a compound shape.
---@param child shape|string # A shape, or its name.
---@param position? vec3like # m
---@param rotation? quat # Default: none.
---@return shape
---@error shape:add_child(shape) --> shape 'ball' is not a compound; create one with sim:add_compound_shape
---@see sim:add_compound_shape
---@example compound
function shape_:add_child(child, position, rotation) end

---@page bodies

---A link of a URDF file; merged links keep their frames.
---@class link
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while its body exists.
---@field body body # read-only. The body that it belongs to.
---@field position vec3 # read-only, m, world.
---@field rotation quat # read-only, world.
---@see body:link, sim:load_urdf
---@example robot

---@page lists

---The bodies of the world.
---@class body_list
---@field [integer] body
---@overload fun(self: sim, wanted?: string|body|(string|body)[]): fun(): body, integer
---@error sim:bodies(3) --> sim has 2 bodies; there is no 3
---@see sim.bodies, sim:body
---@example lists

---The behaviors of a body, in the order in which they run.
---@class behavior_list
---@field [integer] behavior
---@overload fun(self: body, wanted?: string|behavior|(string|behavior)[]): fun(): behavior, integer
---@see body.behaviors
---@example lists

---The parts of a body, or of a behavior.
---@class part_list
---@field [integer] part
---@overload fun(self: body, wanted?: string|part|(string|part)[]): fun(): part, integer
---@see body.parts
---@example lists

---The joints of a body, or of a behavior.
---@class joint_list
---@field [integer] joint
---@overload fun(self: body, wanted?: string|joint|(string|joint)[]): fun(): joint, integer
---@see body.joints
---@example lists

---The gears of the world.
---@class gear_list
---@field [integer] gear
---@overload fun(self: sim, wanted?: string|gear|(string|gear)[]): fun(): gear, integer
---@see sim.gears
---@example lists

---The motors of a body, or of a behavior.
---@class motor_list
---@field [integer] motor
---@overload fun(self: body, wanted?: string|motor|(string|motor)[]): fun(): motor, integer
---@see body.motors
---@example lists
