-- Callbacks of a scene: start, tick, contacts, timers. Each runs by itself; one that errs is switched off and told.
local P = ...
local ffi, api, ctx, answer = P.ffi, P.api, P.ctx, P.answer
local fail, istype, floor, xpcall = P.fail, P.ffi.istype, math.floor, xpcall
local method = P.sim_method
local number = answer.number

-- text, file, line of an error, told outside
function P.report(fault)
  if type(fault) ~= "table" then fault = { file = P.main, line = 0, text = tostring(fault) } end
  api.script_error(ctx, fault.file, #fault.file, fault.line, fault.text, #fault.text)
end

-- calls what is registered, in order; what is registered meanwhile has its turn the next time
local function call_all(list, a, b, c, d)
  local n = #list
  for i = 1, n do
    local entry = list[i]
    if not entry.off then
      local ok, fault = xpcall(entry.f, P.handler, a, b, c, d)
      if not ok then
        entry.off = true
        P.report(fault)
      end
    end
  end
end

local starts, steps, contacts, timers = {}, {}, {}, {}

method("on_start", function(_, f)
  P.want_function(f, "sim:on_start")
  starts[#starts + 1] = { f = f }
end)
method("on_step", function(_, f)
  P.want_function(f, "sim:on_step")
  steps[#steps + 1] = { f = f }
end)
method("on_contact", function(_, f)
  P.want_function(f, "sim:on_contact")
  contacts[#contacts + 1] = { f = f }
end)

-- Timers. A sum of time steps misses a multiple by a few bits, so a nanosecond counts as reached.
local kSlack = 1e-9
local T = ffi.typeof("timer")
local timer_of = setmetatable({}, { __mode = "v" })
local timer_count = 0

local function now() return P.sim.time end

local function add_timer(f, entry)
  timer_count = timer_count + 1
  entry.f, entry.handle = f, T(timer_count)
  timer_of[timer_count] = entry
  timers[#timers + 1] = entry
  return entry.handle
end

local function beats(entry, time) return floor((time + kSlack) / entry.period) end

method("every", function(_, seconds, f)
  if P.want_number(seconds, "sim:every") <= 0 then
    fail("sim:every takes seconds above 0, not %s", tostring(seconds))
  end
  P.want_function(f, "sim:every")
  local entry = { period = seconds }
  entry.beat = beats(entry, now())
  return add_timer(f, entry)
end)
method("after", function(_, seconds, f)
  if P.want_number(seconds, "sim:after") < 0 then
    fail("sim:after takes seconds from 0 on, not %s", tostring(seconds))
  end
  P.want_function(f, "sim:after")
  return add_timer(f, { due = now() + seconds })
end)
method("at", function(_, time, f)
  P.want_number(time, "sim:at")
  P.want_function(f, "sim:at")
  return add_timer(f, { due = time, fixed = true })
end)

-- the run becomes the show, whose timers were looked at last at `time`: beats go on, and what was due does not come again
function P.timers_moved(time)
  for _, entry in ipairs(timers) do
    if entry.period then
      entry.beat = beats(entry, time)
    elseif entry.fixed and time + kSlack >= entry.due then
      entry.off = true
    end
  end
end

local timer_methods = {
  cancel = function(handle)
    if not istype(T, handle) then fail("cancel is a method of a timer: write timer:cancel()") end
    P.needs_callback("timer:cancel")
    local entry = timer_of[handle.number_]
    if entry then entry.off = true end
  end,
}
ffi.metatype(T, {
  __index = function(_, key)
    return timer_methods[key] or fail("a timer has no member '%s'%s", tostring(key), P.hint(key, { "cancel" }))
  end,
  __newindex = function() fail("a timer has nothing to set") end,
  __tostring = function() return "timer" end,
})

local function run_timers()
  local n = #timers
  if n == 0 then return end
  local time = now()
  for i = 1, n do
    local entry = timers[i]
    local due = false
    if entry.off then
      due = false
    elseif entry.period then
      local beat = beats(entry, time)
      due = beat > entry.beat
      entry.beat = beat
    else
      due = time + kSlack >= entry.due
    end
    if due then
      local ok, fault = xpcall(entry.f, P.handler)
      if not ok then P.report(fault) end
      if not (ok and entry.period) then entry.off = true end
    end
  end
  -- what is done goes; the others keep their order
  local kept = 0
  for i = 1, #timers do
    local entry = timers[i]
    if not entry.off then
      kept = kept + 1
      timers[kept] = entry
    end
  end
  for i = #timers, kept + 1, -1 do timers[i] = nil end
end

local function run_contacts()
  if #contacts == 0 then return end
  local i = 0
  while true do
    local code = api.contact(ctx, i)
    if code == -1 then return end
    if code == 0 then
      local impulse, position = number[0], P.V(number[1], number[2], number[3])
      local slot, generation = number[6], number[7]
      local part = P.thing(number[4], number[5])
      call_all(contacts, part, P.thing(slot, generation), impulse, position)
    end
    i = i + 1
  end
end

P.entry = P.entry or {}
function P.entry.start()
  call_all(starts)
end
function P.entry.tick(dt)
  run_timers()
  run_contacts()
  call_all(steps, dt)
end
