-- Functions that a behavior can't call: creating objects and registering callbacks is reserved for the scene.
local P = ...

local function keep_to_scene(functions, key, subject)
  local f = functions[key]
  functions[key] = function(...)
    if P.answer.in_behavior ~= 0 then P.needs_scene(subject) end
    return f(...)
  end
end

local own = { copy = true, load_urdf = true, every = true, after = true, at = true }
for _, name in ipairs(P.sorted_keys(P.classes)) do
  local methods = P.classes[name].methods
  for _, key in ipairs(P.sorted_keys(methods)) do
    if own[key] or key:find("^add_") or key:find("^on_") then keep_to_scene(methods, key, name .. ":" .. key) end
  end
end
for _, key in ipairs { "on", "listen", "stream_to" } do keep_to_scene(P.osc_functions, key, "osc:" .. key) end
