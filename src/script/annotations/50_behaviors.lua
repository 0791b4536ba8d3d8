-- Files of behaviors_lua: each returns a behavior { … }.

---@page behavior_files

---The return value of a file of behaviors_lua. The name of the type is the name of the file.
---@class behavior_definition
---@field doc? string # One sentence about its purpose.
---@field params? param[] # Its parameters, in the order of the panel.
---@field group? boolean # default false. True: attached by sim:add_group_behavior, one instance for each body.
---@field start? fun(self: behavior_self) # Called before the first step, after a reset, and after its parts have changed.
---@field step? fun(self: behavior_self, dt: number) # Called in each tick while active.
---@field migrate? fun(self: behavior_self, old_state: table<string, any>): table<string, any> # Called after a save: converts the state of the earlier version.
---@see behavior_self, param
---@example nod
---@example shy

---Declares a behavior.
---@param definition behavior_definition
---@return behavior_definition
---@error behavior { step = print } --> there is no global 'behavior'; a behavior is a file of its own in behaviors_lua/
---@see behavior_definition
---@example nod
function behavior(definition) end

---The first argument of a behavior's functions: its parameters by name, and these members.
---@class behavior_self
---@field active boolean # Whether it runs.
---@field place integer # Its position, from 1, in the order in which the behaviors of its body run.
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it is attached.
---@field type string # read-only. Its type, such as "cohesion".
---@field body body # read-only. The body that it belongs to.
---@field parts part_list # read-only. The parts that it acts on.
---@field joints joint_list # read-only. The joints that it acts on.
---@field motors motor_list # read-only. The motors that it acts on.
---@field neighbor_parts part_list # read-only. Parts of other bodies that count as neighbors; only in a group.
---@field time number # read-only, s. Simulated time.
---@field state table<string, any> # Plain data; survives a reload.
---@field rng rng # read-only. Its own random generator.
---@field [string] any # Its parameters.
---@see self:due
---@example nod
local behavior_self_ = {}

---True at the first active tick after `start`, and then once per interval of simulation time.
---@param interval string # Name of the parameter with the interval in milliseconds.
---@return boolean
---@example nod
function behavior_self_:due(interval) end

---Iterates over the neighbors of a part: for other, offset, distance in self:neighbors(part, radius) do … Only in a
---group.
---@param part part # A part of the body.
---@param radius number # m
---@return fun(): part, vec3, number
---@see self:neighbor_means, self.neighbor_parts
---@example shy
function behavior_self_:neighbors(part, radius) end

---Means over the neighbors between two distances, computed for the whole group at once: their number, the offset to
---their center (m), their mean velocity relative to the part (m/s), and the same for angular velocity (rad/s). Zeros
---without neighbors. Only in a group.
---@param part part # A part of the body.
---@param min_dist number # m
---@param max_dist number # m
---@return integer
---@return vec3
---@return vec3
---@return vec3
---@see self:neighbor_push
---@example shy
function behavior_self_:neighbor_means(part, min_dist, max_dist) end

---Mean over the neighbors between two distances of the unit vector to the neighbor, times 1 - distance / max_dist.
---Points to where it is crowded. Zero without neighbors. Only in a group.
---@param part part # A part of the body.
---@param min_dist number # m
---@param max_dist number # m
---@return vec3
---@see self:neighbor_means
---@example shy
function behavior_self_:neighbor_push(part, min_dist, max_dist) end

---@page behaviors

---A behavior attached to a body; its parameters are properties.
---@class behavior
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it is attached.
---@field type string # read-only. Its type, such as "cohesion".
---@field body body # read-only. The body that it belongs to.
---@field active boolean # default true. Setting it to any value reactivates a failed behavior.
---@field place integer # Its position, from 1, in the order in which the behaviors of its body run; can be set.
---@field error? string # read-only. The reason why it is suspended although it is active.
---@field time number # read-only, µs. Time spent on it in the last tick.
---@field parts part_list # read-only. The parts that it acts on.
---@field joints joint_list # read-only. The joints that it acts on.
---@field motors motor_list # read-only. The motors that it acts on.
---@field [string] any # Its parameters.
---@see body:add_behavior
---@example wind
local behavior_ = {}

---Detaches it.
---@example wind
function behavior_:remove() end

---@class behavior_opts
---@field parts? string|integer|part|(string|part)[] # Names, patterns, "all".
---@field joints? string|joint|(string|joint)[]
---@field motors? string|motor|(string|motor)[]
---@field active? boolean # default true.
---@field [string] any # The type's parameters.

---A behavior of several bodies.
---@class behavior_group
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field type string # read-only. Its type, such as "cohesion".
---@field active boolean # default true. Setting it sets it for all members.
---@field place integer # Its position, from 1, in the order of all behavior names; can be set.
---@field time number # read-only, µs. Time spent on all its members in the last tick.
---@field [string] any # Its parameters; values set here are set on all members.
---@see sim:add_group_behavior
---@example swarm
local behavior_group_ = {}

---Removes it from all its members.
---@example swarm
function behavior_group_:remove() end

---@class group_opts
---@field bodies? string|body|(string|body)[] # default "all".
---@field parts? string|(string)[] # default "all". The parts it acts on.
---@field neighbor_parts? string|(string)[] # default: same as parts. The parts that count as neighbors.
---@field active? boolean # default true.
---@field [string] any # The type's parameters.
