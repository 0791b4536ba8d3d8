-- What every other prelude file stands on: the door to C++, errors that stand at the script's line, near names.
-- These files are trusted and see ffi and debug; scripts see only what 90_sandbox.lua puts into their environment.
local P = ...
local ffi = require("ffi")

ffi.cdef(P.cdef)
ffi.cdef [[
  typedef struct vec3 { const double x, y, z; } vec3;
  typedef struct quat { const double x, y, z, w; } quat;
  typedef struct flags3 { const bool x, y, z; } flags3;
  typedef struct sim { const int32_t slot_, generation_; } sim;
  typedef struct body { const int32_t slot_, generation_; } body;
  typedef struct part { const int32_t slot_, generation_; } part;
  typedef struct joint { const int32_t slot_, generation_; } joint;
  typedef struct motor { const int32_t slot_, generation_; } motor;
  typedef struct shape { const int32_t slot_, generation_; } shape;
  typedef struct visuals { const int32_t slot_, generation_; } visuals;
  typedef struct camera { const int32_t slot_, generation_; } camera;
  typedef struct look { const int32_t slot_, generation_; } look;
  typedef struct gear { const int32_t slot_, generation_; } gear;
  typedef struct list { const int32_t slot_, generation_, kind_; } list;
  typedef struct link { const int32_t slot_, generation_, number_; } link;
  typedef struct timer { const int32_t number_, run_; } timer;
  typedef struct rng { const int32_t slot_, generation_; } rng;
  typedef struct address { const double ip_; const int32_t port_; } address;
]]

local api = ffi.cast("const struct LimberApi*", P.api)
local ctx = ffi.cast("void*", P.context)
local answer = api.answer(ctx)
local getinfo, format, sub, byte, concat = debug.getinfo, string.format, string.sub, string.byte, table.concat

P.entry = {}       -- what C++ calls
P.on_failure = {}  -- run after a guarded call that failed
P.metas = {}       -- metatables of cdata by the number of the type
local metatype = ffi.metatype
function ffi.metatype(ctype, meta)
  P.metas[tonumber(ffi.typeof(ctype))] = meta
  return metatype(ctype, meta)
end

P.ffi, P.api, P.ctx, P.answer, P.view = ffi, api, ctx, answer, api.view(ctx)

-- the text of the last answer
function P.text() return ffi.string(answer.text, answer.length) end

-- file and line of the nearest script on the stack; prelude files have names without @
function P.where(level)
  for l = level or 2, 200 do
    local info = getinfo(l, "Sl")
    if not info then return nil end
    if byte(info.source, 1) == 64 and info.currentline > 0 then return sub(info.source, 2), info.currentline end
  end
end

-- an error that stands at the script's line, whatever prelude function found it
function P.fail(text, ...)
  if select("#", ...) > 0 then text = format(text, ...) end
  local file, line = P.where(3)
  error(file and format("%s:%d: %s", file, line, text) or text, 0)
end

-- "; did you mean 'x'?" for a list of names
function P.hint(written, names)
  local list = concat(names, "\n")
  written = tostring(written)
  api.hint(ctx, written, #written, list, #list)
  return P.text()
end

function P.sorted_keys(t)
  local keys = {}
  for key in pairs(t) do keys[#keys + 1] = key end
  table.sort(keys, function(a, b) return a < b end)
  return keys
end

-- what an error says that was given; P.label_of knows things (30_things.lua)
function P.describe(value)
  local kind = type(value)
  if kind == "nil" then return "nothing" end
  if kind == "string" then return #value > 60 and format("'%s…'", sub(value, 1, 60)) or format("'%s'", value) end
  if kind == "number" or kind == "boolean" then return tostring(value) end
  if kind == "cdata" then return tostring(value) end
  return "a " .. kind
end

-- a warning that is said once for each line of the script
local said = {}
function P.warn_once(text)
  local file, line = P.where(3)
  local key = file and format("%s:%d", file, line) or "?"
  if said[key] then return end
  said[key] = true
  text = file and format("%s: %s", key, text) or text
  api.warn(ctx, text, #text)
end

-- what the door answered a write, an action or a making; label tells whom it was about
function P.check(code, gone, thing)
  if code == 0 then return end
  if code == 1 then return P.warn_once(P.text()) end
  if code == -2 then return gone(thing) end
  P.fail("%s", P.text())
end

-- what a behaviour may do only in its functions
local function fail_in_behavior(what)
  P.fail("%s acts on the running scene; a behavior acts in its start and step", what)
end

-- actions change a running world; the top level describes one
function P.needs_callback(what)
  if answer.top_level ~= 0 then
    if answer.in_behavior ~= 0 then fail_in_behavior(what) end
    P.fail("%s acts on the running scene; at the top level use sim:on_start(function() … end)", what)
  end
end
function P.needs_top_level(what)
  if answer.top_level == 0 then P.fail("%s declares something about the scene; write it at the top level", what) end
end

-- things and callbacks are the scene's; a behaviour moves what is there
function P.needs_scene(what)
  if answer.in_behavior ~= 0 then
    P.fail("%s makes or registers something: that is the scene's; a behavior moves what is there", what)
  end
end

function P.want_function(f, what)
  if type(f) ~= "function" then P.fail("%s takes a function, not %s", what, P.describe(f)) end
end
function P.want_number(x, what)
  if type(x) ~= "number" then P.fail("%s takes a number, not %s", what, P.describe(x)) end
  if x ~= x or x == math.huge or x == -math.huge then P.fail("%s takes a finite number, not %s", what, tostring(x)) end
  return x
end
function P.want_text(x, what)
  if type(x) ~= "string" then P.fail("%s takes text, not %s", what, P.describe(x)) end
  return x
end
