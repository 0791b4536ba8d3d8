-- Files of behaviors_lua: each returns a behavior { … }.

---The return value of a file of behaviors_lua. The name of the type is the name of the file.
---@class behavior_definition
---@field doc? string # One sentence about its purpose.
---@field params? param[] # In this order in the panel.
---@field group? boolean # default false. Attached by sim:add_group_behavior, one instance for each body.
---@field start? fun(self: behavior_self) # Before the first step, after a reset, and after its parts have changed.
---@field step? fun(self: behavior_self, dt: number) # In each tick while active.
---@field migrate? fun(self: behavior_self, old_state: table<string, any>): table<string, any> # After a save.

---Declares a behavior.
---@param definition behavior_definition
---@return behavior_definition
function behavior(definition) end

---The first argument of a behavior's functions: its parameters by name, and these members.
---@class behavior_self
---@field active boolean
---@field place integer # Its position, from 1, in the order in which the behaviors of its body run.
---@field name string # read-only.
---@field alive boolean # read-only. True while it is attached.
---@field type string # read-only.
---@field body body # read-only.
---@field parts part_list # read-only.
---@field joints joint_list # read-only.
---@field motors motor_list # read-only.
---@field neighbor_parts part_list # read-only. Of other bodies; only in a group.
---@field time number # read-only, s.
---@field state table<string, any> # Plain data; survives a reload.
---@field rng rng # read-only. Its own random generator.
---@field [string] any # Its parameters.
local behavior_self_ = {}

---True at the first active tick after `start`, and then once per interval of simulation time.
---@param interval string # Name of the parameter with the interval in milliseconds.
---@return boolean
function behavior_self_:due(interval) end

---Iterates over the neighbors of a part: for other, offset, distance in self:neighbors(part, radius) do … Only in a
---group.
---@param part part
---@param radius number # m
---@return fun(): part, vec3, number
function behavior_self_:neighbors(part, radius) end

---Means over the neighbors between two distances, computed for the whole group at once: their number, the offset to
---their center (m), their mean velocity relative to the part (m/s), and the same for angular velocity (rad/s). Zeros
---without neighbors. Only in a group.
---@param part part
---@param min_dist number # m
---@param max_dist number # m
---@return integer
---@return vec3
---@return vec3
---@return vec3
function behavior_self_:neighbor_means(part, min_dist, max_dist) end

---Mean over the neighbors between two distances of the unit vector to the neighbor, times 1 - distance / max_dist.
---Points to where it is crowded. Zero without neighbors. Only in a group.
---@param part part
---@param min_dist number # m
---@param max_dist number # m
---@return vec3
function behavior_self_:neighbor_push(part, min_dist, max_dist) end

---A behavior attached to a body; its parameters are properties.
---@class behavior
---@field name string # read-only.
---@field alive boolean # read-only. True while it is attached.
---@field type string # read-only.
---@field body body # read-only.
---@field active boolean # default true. Setting it to any value reactivates a failed behavior.
---@field place integer # Its position, from 1, in the order in which the behaviors of its body run; can be set.
---@field error? string # read-only. The reason why it is suspended although it is active.
---@field time number # read-only, µs. Time spent on it in the last tick.
---@field parts part_list # read-only.
---@field joints joint_list # read-only.
---@field motors motor_list # read-only.
---@field [string] any # Its parameters.
local behavior_ = {}

---Detaches it.
function behavior_:remove() end

---@class behavior_opts
---@field parts? string|integer|part|(string|part)[] # Names, patterns, "all".
---@field joints? string|joint|(string|joint)[]
---@field motors? string|motor|(string|motor)[]
---@field active? boolean # default true.
---@field [string] any # The type's parameters.

---A behavior of several bodies.
---@class behavior_group
---@field name string # read-only.
---@field alive boolean # read-only.
---@field type string # read-only.
---@field active boolean # default true. Setting it sets it for all members.
---@field place integer # Its position, from 1, in the order of all behavior names; can be set.
---@field time number # read-only, µs. Time spent on all its members in the last tick.
---@field [string] any # Its parameters; values set here are set on all members.
local behavior_group_ = {}

---Removes it from all its members.
function behavior_group_:remove() end

---@class group_opts
---@field bodies? string|body|(string|body)[] # default "all".
---@field parts? string|(string)[] # default "all". The parts it acts on.
---@field neighbor_parts? string|(string)[] # default: same as parts. The parts that count as neighbors.
---@field active? boolean # default true.
---@field [string] any # The type's parameters.
