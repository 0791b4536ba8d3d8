-- Basis of all prelude files: the C API, errors attributed to the script's line, name suggestions. Prelude files are
-- trusted and can use ffi and debug; scripts see only the environment from sandbox.lua.
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
  typedef struct clock { const int32_t slot_, generation_; } clock;
  typedef struct gear { const int32_t slot_, generation_; } gear;
  typedef struct imu { const int32_t slot_, generation_; } imu;
  typedef struct range_finder { const int32_t slot_, generation_; } range_finder;
  typedef struct zone { const int32_t slot_, generation_; } zone;
  typedef struct touch { const int32_t slot_, generation_; } touch;
  typedef struct tendon { const int32_t slot_, generation_; } tendon;
  typedef struct fixture { const int32_t slot_, generation_; } fixture;
  typedef struct mocap { const int32_t slot_, generation_; } mocap;
  typedef struct mocap_joint { const int32_t slot_, generation_; } mocap_joint;
  typedef struct route { const int32_t slot_, generation_; } route;
  typedef struct list { const int32_t slot_, generation_, kind_; } list;
  typedef struct link { const int32_t slot_, generation_, number_; } link;
  typedef struct timer { const int32_t number_, run_; } timer;
  typedef struct rng { const int32_t slot_, generation_; } rng;
  typedef struct policy { const int32_t number_; } policy;
  typedef struct address { const struct LimberAddress to_; } address;
]]

local api = ffi.cast("const struct LimberApi*", P.api)
local ctx = ffi.cast("void*", P.context)
local answer = api.answer(ctx)
local getinfo, format, sub, byte, concat = debug.getinfo, string.format, string.sub, string.byte, table.concat

P.exports = {}       -- functions called from C++
P.on_failure = {}  -- functions to run after a guarded call that failed
P.metatables = {}  -- metatables of cdata by the number of the type
local metatype = ffi.metatype
function ffi.metatype(ctype, meta)
  P.metatables[tonumber(ffi.typeof(ctype))] = meta
  return metatype(ctype, meta)
end

P.ffi, P.api, P.ctx, P.answer, P.view = ffi, api, ctx, answer, api.view(ctx)

-- the text of the last answer
function P.text() return ffi.string(answer.text, answer.length) end

-- file and line of the innermost script function on the stack; names of prelude files do not begin with @
function P.script_place(level)
  for l = level or 2, 200 do
    local info = getinfo(l, "Sl")
    if not info then return nil end
    if byte(info.source, 1) == 64 and info.currentline > 0 then return sub(info.source, 2), info.currentline end
  end
end

-- raises an error at the script's line, whichever prelude function detected it
function P.fail(text, ...)
  if select("#", ...) > 0 then text = format(text, ...) end
  local file, line = P.script_place(3)
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

-- text of a value for error messages; labels of objects are added in objects.lua
function P.describe(value)
  local kind = type(value)
  if kind == "nil" then return "nothing" end
  if kind == "string" then return #value > 60 and format("'%s…'", sub(value, 1, 60)) or format("'%s'", value) end
  if kind == "number" or kind == "boolean" then return tostring(value) end
  if kind == "cdata" then return tostring(value) end
  return "a " .. kind
end

-- logs a warning, at most once for each line of the script
local warned = {}
function P.warn_once(text)
  local file, line = P.script_place(3)
  local key = file and format("%s:%d", file, line) or "?"
  if warned[key] then return end
  warned[key] = true
  text = file and format("%s: %s", key, text) or text
  api.warn(ctx, text, #text)
end

-- handles the result code of a write, an action or a creation; `fail_removed` raises the error for a removed object
function P.handle_result(code, fail_removed, object)
  if code == 0 then return end
  if code == 1 then return P.warn_once(P.text()) end
  if code == -2 then return fail_removed(object) end
  P.fail("%s", P.text())
end

-- Checks. `subject`: the start of the error message, such as "sim:every" or "add_part: mass".

-- error for functions that a behavior can use only in its start and step
local function fail_in_behavior(subject)
  P.fail("%s acts on the running scene; a behavior acts in its start and step", subject)
end

-- actions change a running world; the top level only describes it
function P.needs_callback(subject)
  if answer.top_level ~= 0 then
    if answer.in_behavior ~= 0 then fail_in_behavior(subject) end
    P.fail("%s acts on the running scene; at the top level use sim:on_start(function() … end)", subject)
  end
end
function P.needs_top_level(subject)
  if answer.top_level == 0 then P.fail("%s declares something about the scene; write it at the top level", subject) end
end

-- only the scene creates objects and registers callbacks; a behavior controls existing objects
function P.needs_scene(subject)
  if answer.in_behavior ~= 0 then
    P.fail("%s creates or registers something, which only a scene can do; a behavior controls existing objects", subject)
  end
end

function P.check_function(f, subject)
  if type(f) ~= "function" then P.fail("%s takes a function, not %s", subject, P.describe(f)) end
end
function P.check_number(x, subject)
  if type(x) ~= "number" then P.fail("%s takes a number, not %s", subject, P.describe(x)) end
  if x ~= x or x == math.huge or x == -math.huge then
    P.fail("%s takes a finite number, not %s", subject, tostring(x))
  end
  return x
end
function P.check_text(x, subject)
  if type(x) ~= "string" then P.fail("%s takes text, not %s", subject, P.describe(x)) end
  return x
end
