-- Callbacks of a scene: start, tick, contacts, timers. Each is a guarded call; one that errs is switched off and told.
local P = ...
local ffi, api, ctx, answer, guarded = P.ffi, P.api, P.ctx, P.answer, P.guarded
local fail, istype, floor = P.fail, P.ffi.istype, math.floor
local method = P.sim_method
local number = answer.number

-- What a call registers is taken back when it fails: what to undo, and how long a list was. Entries of the call before
-- are of no use any more.
local journal = {}
function P.log(list)
  if #journal > 0 and journal[1].call ~= answer.call then journal = {} end
  journal[#journal + 1] = { call = answer.call, list = list, count = #list }
end
local function add(list, entry)
  P.log(list)
  list[#list + 1] = entry
end
P.on_failure[#P.on_failure + 1] = function()
  for i = #journal, 1, -1 do
    local done = journal[i]
    if done.call == answer.call then
      if done.timer then done.timer.off = nil end
      if done.list then
        for k = #done.list, done.count + 1, -1 do done.list[k] = nil end
      end
    end
  end
  journal = {}
end

-- calls what is registered, in order; what is registered meanwhile has its turn the next time
local function call_all(list, a, b, c, d)
  local n = #list
  for i = 1, n do
    local entry = list[i]
    if not entry.off then
      if not guarded(entry.f, a, b, c, d) then
        entry.off = true
        api.report(ctx)
      end
    end
  end
end
jit.off(call_all)

local starts, steps, contacts, timers = {}, {}, {}, {}

method("on_start", function(_, f)
  P.want_function(f, "sim:on_start")
  add(starts, { f = f })
end)
method("on_step", function(_, f)
  P.want_function(f, "sim:on_step")
  add(steps, { f = f })
end)
method("on_contact", function(_, f)
  P.want_function(f, "sim:on_contact")
  add(contacts, { f = f })
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
  add(timers, entry)
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
    if not entry or entry.off then return end
    P.log(timers)
    journal[#journal].timer = entry
    entry.off = true
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
      local ok = guarded(entry.f)
      if not ok then api.report(ctx) end
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
jit.off(run_timers)

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

function P.entry.start()
  call_all(starts)
end
function P.entry.tick(dt)
  run_timers()
  run_contacts()
  call_all(steps, dt)
end
