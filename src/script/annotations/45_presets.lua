-- Presets: the named states of the show.

---Named copies of values, in order, kept in a file beside the scene. What a callback asks of them is done once the
---callbacks of the tick are. The preset "script" is always there: every property as the scene describes it.
---@class presets
---@field names string[] # read-only. Of all but "script", in their order.
presets = {}

---@class preset_opts
---@field rows? string|string[] # Patterns of what is kept, "behaviors" or "looks"; left out: every property.
---@field except? string|string[] # Patterns of what a recall leaves alone.
---@field poses? boolean # With where every part is.
---@field velocities? boolean # With how it moves.

---Keeps values as they are now. One of that name is replaced; without options it is made of what it was made of before.
---@param name string
---@param opts? preset_opts
function presets:store(name, opts) end

---Brings values back, at once or over simulated seconds. 2.5 is half-way between the second and the third preset.
---@param which string|number
---@param seconds? number
---@param easing? "smooth"|"linear"|"in"|"out" # default "smooth".
function presets:recall(which, seconds, easing) end

---Sets what lies between two presets.
---@param a string|integer
---@param b string|integer
---@param amount number # 0: the first, 1: the second.
function presets:morph(a, b, amount) end

---Forgets a preset.
---@param which string|integer
function presets:delete(which) end
