-- Bodies and their components. Objects can be compared and used as table keys.

---A named set of parts, joints and motors.
---@class body
---@field name string # read-only.
---@field alive boolean # read-only. True while it exists; any other use of a removed object is an error.
---@field root part # read-only. The first part.
---@field parts part_list # read-only. In stream order; call it to iterate over those that match a pattern.
---@field joints joint_list # read-only. In stream order; call it to iterate over those that match a pattern.
---@field motors motor_list # read-only. In stream order; call it to iterate over those that match a pattern.
---@field behaviors behavior_list # read-only. In the order of attachment.
---@field excluded_pairs part[][] # read-only. Pairs of parts that are excluded from collision: `{ { a, b }, … }`.
---@properties body
local body_ = {}

---@class body_opts
---@opts body

---Adds a part with that shape. The pose is in world coordinates; default: the origin.
---@param name string
---@param shape shape|string
---@param opts? part_opts # `mass` 0: static.
---@return part
function body_:add_part(name, shape, opts) end

---Adds a joint between two parts. Their current pose is its zero position; its own axis is unlimited until limits are
---set.
---@param name string
---@param parent part|string|integer
---@param child part|string|integer
---@param opts? joint_opts
---@return joint
function body_:add_joint(name, parent, child, opts) end

---Adds a motor to a joint, with the joint's name; initially a servo that holds the position.
---@param joint joint|string|integer
---@param opts? motor_opts
---@return motor
function body_:add_motor(joint, opts) end

---Returns a part by name or number (-1: the last). If there is none, the error suggests similar names.
---@param key string|integer|part
---@return part
function body_:part(key) end

---Returns a joint by name or number (-1: the last).
---@param key string|integer|joint
---@return joint
function body_:joint(key) end

---Attaches a behavior: a built-in type, or a file of behaviors_lua/.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string
---@param opts? behavior_opts # Targets (default: all), `active`, and the type's parameters.
---@return behavior
function body_:add_behavior(type, name, opts) end

---Returns a behavior by name or number (-1: the last).
---@param key string|integer|behavior
---@return behavior
function body_:behavior(key) end

---Returns a motor by name or number (-1: the last).
---@param key string|integer|motor
---@return motor
function body_:motor(key) end

---Returns a link of the URDF file, including merged ones.
---@param name string
---@return link
function body_:link(name) end

---Creates a copy of the body as it has been described so far.
---@param name string
---@param opts? body_opts
---@return body
function body_:copy(name, opts) end

---Excludes two parts of the body from collision with each other.
---@param a part|string|integer
---@param b part|string|integer
function body_:exclude_pair(a, b) end

---Enables collision of two parts that was excluded by exclude_pair or by an overlap at the home pose.
---@param a part|string|integer
---@param b part|string|integer
function body_:include_pair(a, b) end

---@action body reset
function body_:reset() end

---@action body remove
function body_:remove() end

---Returns a hash of the body's exact state; equal states have equal hashes.
---@return string
function body_:state_hash() end

---A rigid part of a body.
---@class part
---@field name string # read-only.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only.
---@field shape shape # read-only.
---@properties part
local part_ = {}

---@class part_opts
---@opts part

---@action part apply_force
---@param force vec3like
---@param at? vec3like
function part_:apply_force(force, at) end

---@action part apply_impulse
---@param impulse vec3like
---@param at? vec3like
function part_:apply_impulse(impulse, at) end

---@action part apply_torque
---@param torque vec3like
function part_:apply_torque(torque) end

---A connection of two parts. Its own axis is z of the joint's frame.
---@class joint
---@field name string # read-only.
---@field alive boolean # read-only. True while it exists.
---@field type "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # read-only.
---@field body body # read-only.
---@field parent part # read-only.
---@field child part # read-only.
---@field motor? motor # read-only. nil if it has none.
---@properties joint
local joint_ = {}

---@class joint_opts
---@field type? "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # default "revolute".
---@field position? vec3like # m, world; default: the child's.
---@field axis? vec3like # world, default 0 0 1.
---@opts joint

---Drives a joint. Properties with three axes accept a vec3, or one number for the own axis (booleans: for all axes).
---@class motor
---@field name string # read-only. The joint's.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only.
---@field joint joint # read-only.
---@properties motor
local motor_ = {}

---@class motor_opts
---@opts motor

---Couples two joints in both directions: position of b = ratio * position of a + offset. Created by sim:add_gear.
---@class gear
---@field name string # read-only.
---@field alive boolean # read-only. True while it exists; it is removed with the bodies of its joints.
---@field joint_a joint # read-only.
---@field joint_b joint # read-only.
---@properties gear
local gear_ = {}

---@action gear remove
function gear_:remove() end

---@class gear_opts
---@field name? string # default: the names of both joints.
---@opts gear

---Geometry of parts for rendering and collision.
---@class shape
---@field name string # read-only.
---@field alive boolean # read-only. True while it exists.
---@properties shape
local shape_ = {}

---Adds a shape to a compound shape.
---@param child shape|string
---@param position? vec3like # m
---@param rotation? quat
---@return shape
function shape_:add_child(child, position, rotation) end

---A link of a URDF file; merged links keep their frames.
---@class link
---@field name string # read-only.
---@field alive boolean # read-only. True while its body exists.
---@field body body # read-only.
---@field position vec3 # read-only, m, world.
---@field rotation quat # read-only, world.

---@class body_list
---@field [integer] body
---@overload fun(self: sim, wanted?: string|body|(string|body)[]): fun(): body, integer

---@class behavior_list
---@field [integer] behavior
---@overload fun(self: body, wanted?: string|behavior|(string|behavior)[]): fun(): behavior, integer

---@class part_list
---@field [integer] part
---@overload fun(self: body, wanted?: string|part|(string|part)[]): fun(): part, integer

---@class joint_list
---@field [integer] joint
---@overload fun(self: body, wanted?: string|joint|(string|joint)[]): fun(): joint, integer

---@class gear_list
---@field [integer] gear
---@overload fun(self: sim, wanted?: string|gear|(string|gear)[]): fun(): gear, integer

---@class motor_list
---@field [integer] motor
---@overload fun(self: body, wanted?: string|motor|(string|motor)[]): fun(): motor, integer
