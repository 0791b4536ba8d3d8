-- What a behaviour can't do: make things, register callbacks. These are the scene's.
local P = ...

local function keep_to_scene(functions, key, what)
  local f = functions[key]
  functions[key] = function(...)
    if P.answer.in_behavior ~= 0 then P.needs_scene(what) end
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
