-- Bodies and what they are made of. Things can be compared and be keys of tables.

---Parts, joints and motors under one name.
---@class body
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists; any other use of a gone thing is an error.
---@field root part # read-only. The first part.
---@field parts part_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field joints joint_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field motors motor_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field behaviors behavior_list # read-only. In the order in which they were attached.
---@field excluded_pairs part[][] # read-only. Pairs of parts that are excluded from collision: `{ { a, b }, … }`.
---@rows body
local body_ = {}

---@class body_opts
---@opts body

---A part of that shape. Its pose is in the world, left out: the origin.
---@param name string
---@param shape shape|string
---@param opts? part_opts # `mass` 0: it never moves.
---@return part
function body_:add_part(name, shape, opts) end

---A joint between two parts. The pose it is made in is its zero; its own motion is free until it gets limits.
---@param name string
---@param parent part|string|integer
---@param child part|string|integer
---@param opts? joint_opts
---@return joint
function body_:add_joint(name, parent, child, opts) end

---The motor of a joint, with the joint's name; made as a servo that holds.
---@param joint joint|string|integer
---@param opts? motor_opts
---@return motor
function body_:add_motor(joint, opts) end

---A part by its name or number (-1: the last). An error with the near names when there is none.
---@param key string|integer|part
---@return part
function body_:part(key) end

---A joint by its name or number (-1: the last).
---@param key string|integer|joint
---@return joint
function body_:joint(key) end

---Attaches a behaviour: a built-in type, or a file of behaviors_lua/.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string
---@param opts? behavior_opts # Whom it acts on (left out: all), `active`, and the type's parameters.
---@return behavior
function body_:add_behavior(type, name, opts) end

---A behaviour by its name or number (-1: the last).
---@param key string|integer|behavior
---@return behavior
function body_:behavior(key) end

---A motor by its name or number (-1: the last).
---@param key string|integer|motor
---@return motor
function body_:motor(key) end

---A link of the URDF file, a merged one too.
---@param name string
---@return link
function body_:link(name) end

---A copy of all that is said about the body up to here.
---@param name string
---@param opts? body_opts
---@return body
function body_:copy(name, opts) end

---Excludes two parts of the body from collision with each other.
---@param a part|string|integer
---@param b part|string|integer
function body_:exclude_pair(a, b) end

---Lets two parts collide that exclude_pair, or an overlap at the home pose, excluded.
---@param a part|string|integer
---@param b part|string|integer
function body_:include_pair(a, b) end

---@action body reset
function body_:reset() end

---@action body remove
function body_:remove() end

---Text that is the same when the body is the same to the bit.
---@return string
function body_:state_hash() end

---A rigid piece of a body.
---@class part
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists.
---@field body body # read-only.
---@field shape shape # read-only.
---@rows part
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

---What ties two parts. Its own axis is z of the joint's frame.
---@class joint
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists.
---@field type "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # read-only.
---@field body body # read-only.
---@field parent part # read-only.
---@field child part # read-only.
---@field motor? motor # read-only. nil when it has none.
---@rows joint
local joint_ = {}

---@class joint_opts
---@field type? "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # default "revolute".
---@field position? vec3like # m, world; left out: the child's.
---@field axis? vec3like # world, default 0 0 1.
---@opts joint

---What moves a joint. Rows of three axes take a vec3, or one number for the own axis (booleans: for all axes).
---@class motor
---@field name string # read-only. The joint's.
---@field alive boolean # read-only. Whether it still exists.
---@field body body # read-only.
---@field joint joint # read-only.
---@rows motor
local motor_ = {}

---@class motor_opts
---@opts motor

---Couples two joints both ways: position of b = ratio * position of a + offset. Made by sim:add_gear.
---@class gear
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists; it goes with its joints' bodies.
---@field joint_a joint # read-only.
---@field joint_b joint # read-only.
---@rows gear
local gear_ = {}

---@action gear remove
function gear_:remove() end

---@class gear_opts
---@field name? string # Left out: the names of both joints.
---@opts gear

---What parts look like and touch with.
---@class shape
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists.
---@rows shape
local shape_ = {}

---Adds a shape to a compound one.
---@param child shape|string
---@param position? vec3like # m
---@param rotation? quat
---@return shape
function shape_:add_child(child, position, rotation) end

---A link of a URDF file; a merged one keeps its frame.
---@class link
---@field name string # read-only.
---@field alive boolean # read-only. Whether its body still exists.
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
