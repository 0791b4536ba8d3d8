-- Presets: saved states of the show.

---@page presets

---Named sets of values, in order, saved in a file beside the scene. Operations requested by a callback are carried out
---after the callbacks of the tick. The preset "script" always exists: all properties as the scene describes them.
---@class presets
---@field names string[] # read-only. All but "script", in order.
---@see params
---@example presets
presets = {}

---@class preset_opts
---@field rows? string|string[] # Patterns of the properties to store, "behaviors" or "looks"; default: all properties.
---@field except? string|string[] # Patterns of the properties that a recall does not change.
---@field poses? boolean # Include the poses of all parts.
---@field velocities? boolean # Include velocities.

---Stores current values. Replaces a preset of the same name; without options, stores the same properties as before.
---@param name string # A name of your choice.
---@param opts? preset_opts
---@error presets:store("calm") --> presets:store acts on the running scene; at the top level use sim:on_start(function() … end)
---@see presets:recall
---@example presets
function presets:store(name, opts) end

---Recalls values, at once or over some seconds of simulation time. 2.5 is half-way between the second and the third
---preset.
---@param which string|number # A name, or a number from 1.
---@param seconds? number # s, simulation time; default 0: at once.
---@param easing? "smooth"|"linear"|"in"|"out" # default "smooth".
---@see presets:morph
---@example presets
function presets:recall(which, seconds, easing) end

---Sets values between two presets.
---@param a string|integer # A name, or a number from 1.
---@param b string|integer # A name, or a number from 1.
---@param amount number # 0: the first, 1: the second.
---@see presets:recall
---@example presets
function presets:morph(a, b, amount) end

---Renames a preset. Its values and its position in the order stay.
---@param which string|integer
---@param name string # New name; no other preset may have it.
---@see presets:store
---@example presets
function presets:rename(which, name) end

---Deletes a preset.
---@param which string|integer # A name, or a number from 1.
---@example presets
function presets:delete(which) end
