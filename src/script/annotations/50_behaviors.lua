-- Files of behaviors_lua: each returns a behavior { … }.

---What a file of behaviors_lua returns. The type's name is the file's name.
---@class behavior_definition
---@field doc? string # What it does, in a sentence.
---@field params? param[] # In this order in the panel.
---@field group? boolean # default false. It is attached by sim:add_group_behavior, one instance for each body.
---@field start? fun(self: behavior_self) # Before the first step, after each reset, and when its parts or motors have changed.
---@field step? fun(self: behavior_self, dt: number) # In each tick while it is active.
---@field migrate? fun(self: behavior_self, old_state: table<string, any>): table<string, any> # When its file was saved.

---Declares a behaviour.
---@param definition behavior_definition
---@return behavior_definition
function behavior(definition) end

---What the functions of a behaviour get: its parameters by their names, and these.
---@class behavior_self
---@field active boolean
---@field place integer # Which one it is, from 1, of those that act on its body in a tick.
---@field name string # read-only.
---@field alive boolean # read-only. Whether it is still attached.
---@field type string # read-only.
---@field body body # read-only.
---@field parts part_list # read-only.
---@field joints joint_list # read-only.
---@field motors motor_list # read-only.
---@field neighbor_parts part_list # read-only. Of the other bodies; only of a group.
---@field time number # read-only, s.
---@field state table<string, any> # Plain data; it survives a reload.
---@field rng rng # read-only. Its own generator.
---@field [string] any # Its parameters.
local behavior_self_ = {}

---True at the first active tick after `start`, and then every so many simulated milliseconds.
---@param interval string # The parameter that holds the milliseconds.
---@return boolean
function behavior_self_:due(interval) end

---The neighbours of a part: for other, offset, distance in self:neighbors(part, radius) do … Only of a group.
---@param part part
---@param radius number # m
---@return fun(): part, vec3, number
function behavior_self_:neighbors(part, radius) end

---Means over the neighbours between two distances, found for the whole group at once: how many there are, the way to
---their middle (m), their mean velocity less the part's own (m/s), and the same of angular velocities (rad/s). Zeros
---without neighbours. Only of a group.
---@param part part
---@param min_dist number # m
---@param max_dist number # m
---@return integer
---@return vec3
---@return vec3
---@return vec3
function behavior_self_:neighbor_means(part, min_dist, max_dist) end

---The mean over the neighbours between two distances of: a unit vector to the neighbour, times 1 - distance / max_dist.
---It points to where it is crowded. Zero without neighbours. Only of a group.
---@param part part
---@param min_dist number # m
---@param max_dist number # m
---@return vec3
function behavior_self_:neighbor_push(part, min_dist, max_dist) end

---A behaviour that is attached to a body; its parameters are properties.
---@class behavior
---@field name string # read-only.
---@field alive boolean # read-only. Whether it is still attached.
---@field type string # read-only.
---@field body body # read-only.
---@field active boolean # default true. Setting it, to whatever, lets one that failed try again.
---@field place integer # Which one it is, from 1, of those that act on its body in a tick; setting it puts it there.
---@field error? string # read-only. Why it rests although it is active.
---@field time number # read-only, µs. What the last tick spent on it.
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

---A behaviour of several bodies.
---@class behavior_group
---@field name string # read-only.
---@field alive boolean # read-only.
---@field type string # read-only.
---@field active boolean # default true. Setting it sets that of every member.
---@field place integer # Which one it is, from 1, of all names of behaviours; setting it puts it there.
---@field time number # read-only, µs. What the last tick spent on all of it.
---@field [string] any # Its parameters: what is written goes to every member.
local behavior_group_ = {}

---Takes it away from all its members.
function behavior_group_:remove() end

---@class group_opts
---@field bodies? string|body|(string|body)[] # default "all".
---@field parts? string|(string)[] # default "all". The own parts that it acts on.
---@field neighbor_parts? string|(string)[] # Left out: as parts. Those that are looked at.
---@field active? boolean # default true.
---@field [string] any # The type's parameters.
