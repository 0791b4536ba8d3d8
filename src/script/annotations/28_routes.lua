-- Routes.

---@page routes

---Adds a route: in each tick, before the behaviors, it sets a property to the value of another one. A range, a curve,
---smoothing and a lag shape the value. An end is an address, a pattern of addresses, or an object and the name of its
---property; `.x`, `.y`, `.z`, `.w` and, for a source, `.length` select a number of a vector. An end that does not exist
---yet is reported, and the route waits for it.
---@param name string # A name of your choice, unique among the routes.
---@param opts route_opts # `from`, `to`, and properties such as `smoothing`.
---@return route
---@error sim:add_route("glow", { to = "/physics/sim/speed" }) --> add_route: from is an address, or { object, "property" }, not nothing
---@error sim:add_route("glow", { from = "time", to = "/physics/sim/speed" }) --> route 'glow': from: 'time' is not an address: it must begin with /
---@error sim:add_route("glow", { from = "/physics/sim/time", to = "/physics/sim/speed", input = 4 }) --> add_route: input is two numbers { low, high }, not 4
---@see route, sim:route
---@example routes
function sim:add_route(name, opts) end

---Returns a route by name or number (-1: the last).
---@param key string|integer|route # Its name, its number from 1, or -1 for the last.
---@return route
---@error sim:route("glow") --> there is no route 'glow'; none exist
---@see sim.routes
---@example routes
function sim:route(key) end

---A connection that sets a property to the value of another one in each tick.
---@class route
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@properties route
---@see sim:add_route
---@example routes
local route_ = {}

---@action route remove
---@example routes
function route_:remove() end

---@class route_opts
---@field from string|table # An address or pattern, or `{ object, "property" }`.
---@field to string|table # The same for the target.
---@field input? number[] # `{ low, high }`: sets `input_low` and `input_high`.
---@field output? number[] # `{ low, high }`: sets `output_low` and `output_high`. With `input` or `output`, `clamp` is true unless it is set.
---@opts route

---@page lists

---The routes of the world.
---@class route_list
---@field [integer] route
---@overload fun(self: sim, wanted?: string|route|(string|route)[]): fun(): route, integer
---@see sim.routes
---@example lists
