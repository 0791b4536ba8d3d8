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
---@field name string # read-only.
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
