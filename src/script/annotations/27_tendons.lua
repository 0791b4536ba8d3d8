-- Tendons.

---@page tendons

---Adds a tendon through two or more points on parts, also of other bodies. Its length at this moment becomes its
---`rest_length`, unless that is an option. It is removed with each of these bodies.
---@param name string # A name of your choice, unique among the tendons of the body.
---@param opts tendon_opts # `points`, and properties such as `stiffness`.
---@return tendon
---@error body:add_tendon("cord", {}) --> add_tendon: points is a list of points {part, x, y, z}, not nothing
---@error body:add_tendon("cord", { points = { { 1, 0, 0, 0 } } }) --> tendon 'body/cord': needs 2 .. 64 points, not 1
---@error body:add_tendon("cord", { points = { { 1 }, { 1, 0, 0, 1 } } }) --> tendon 'body/cord': all points are on the part 'ball'; a tendon connects at least two parts
---@error body:add_tendon("cord", { points = { { 1 }, { 1, 0 / 0 } } }) --> add_tendon: point 2: x takes a finite number, not nan
---@error body:add_tendon("cord", { points = { { 1 }, { true } } }) --> add_tendon: point 2: its part is a part, or the name of one of the body, not true
---@see tendon, body:tendon
---@example tendons
function body_:add_tendon(name, opts) end

---Returns a tendon by name or number (-1: the last).
---@param key string|integer|tendon # Its name, its number from 1, or -1 for the last.
---@return tendon
---@error body:tendon("cord") --> body 'body' has no tendon 'cord'; none exist
---@see body.tendons
---@example tendons
function body_:tendon(key) end

---A cable that slides through points on parts, with the same tension along its length.
---@class tendon
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field points tendon_point[] # read-only. Its points, in their order.
---@properties tendon
---@see body:add_tendon
---@example tendons
local tendon_ = {}

---@action tendon remove
---@example tendons
function tendon_:remove() end

---A point of a tendon.
---@class tendon_point
---@field part part # The part that it is on.
---@field position vec3 # Its place in m, in the part's link frame.
---@see tendon.points
---@example tendons

---@class tendon_opts
---@field points table[] # At least two points: `{ part, x, y, z }` or `{ part, vec3 }`, in m in the part's link frame; default: its origin. A part of the body can be given by its name.
---@opts tendon

---@page lists

---The tendons of a body.
---@class tendon_list
---@field [integer] tendon
---@overload fun(self: body, wanted?: string|tendon|(string|tendon)[]): fun(): tendon, integer
---@see body.tendons
---@example lists
