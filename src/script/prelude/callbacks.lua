-- Callbacks of a scene: start, tick, contacts, timers. Each is a guarded call; one that fails is disabled and reported.
local P = ...
local ffi, api, ctx, answer, guarded = P.ffi, P.api, P.ctx, P.answer, P.guarded
local fail, istype, floor = P.fail, P.ffi.istype, math.floor
local method = P.sim_method
local number = answer.number

-- Registrations of a call that fails are rolled back. Each entry has a timer to reactivate, or a list and its previous
-- length. Entries of earlier calls are obsolete.
local journal = {}
function P.journal(list)
  if #journal > 0 and journal[1].call ~= answer.call then journal = {} end
  journal[#journal + 1] = { call = answer.call, list = list, count = #list }
end
-- True in an earlier run: its file has been saved since, so only timers of its callbacks continue.
local earlier = false

-- returns true in an earlier run, which can't register anything any more (reported once for each line)
function P.is_earlier_run(subject)
  if earlier then
    P.warn_once(subject ..
      " is ignored: this function belongs to a run before the last save, of which only timers continue")
  end
  return earlier
end

local function add(list, entry, subject)
  if P.is_earlier_run(subject) then return end
  P.journal(list)
  entry.in_callback = answer.top_level == 0
  list[#list + 1] = entry
end
P.on_failure[#P.on_failure + 1] = function()
  for i = #journal, 1, -1 do
    local record = journal[i]
    if record.call == answer.call then
      if record.timer then record.timer.off = nil end
      if record.list then
        for k = #record.list, record.count + 1, -1 do record.list[k] = nil end
      end
    end
  end
  journal = {}
end

-- calls the registered functions in order; functions registered meanwhile are called from the next time on
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
  add(starts, { f = f }, "sim:on_start")
end)
method("on_step", function(_, f)
  P.want_function(f, "sim:on_step")
  add(steps, { f = f }, "sim:on_step")
end)
method("on_contact", function(_, f)
  P.want_function(f, "sim:on_contact")
  add(contacts, { f = f }, "sim:on_contact")
end)

-- Timers. A sum of time steps misses a multiple by a few bits, so a timer is due one nanosecond early.
local kTolerance = 1e-9
local T = ffi.typeof("timer")
local timer_of = setmetatable({}, { __mode = "v" })
local timer_count = 0
local afters = {}  -- the top level's sim:after in their order, including finished ones; the next run takes them over

local function now() return P.sim.time end

local function add_timer(f, entry)
  timer_count = timer_count + 1
  entry.f, entry.handle = f, T(timer_count, 0)
  entry.in_callback = answer.top_level == 0
  timer_of[timer_count] = entry
  P.journal(timers)
  timers[#timers + 1] = entry
  return entry.handle
end

local function periods_until(entry, time) return floor((time + kTolerance) / entry.period) end

method("every", function(_, seconds, f)
  if P.want_number(seconds, "sim:every") <= 0 then
    fail("sim:every takes seconds above 0, not %s", tostring(seconds))
  end
  P.want_function(f, "sim:every")
  local entry = { period = seconds }
  entry.periods = periods_until(entry, now())
  return add_timer(f, entry)
end)
method("after", function(_, seconds, f)
  if P.want_number(seconds, "sim:after") < 0 then
    fail("sim:after takes seconds of 0 or more, not %s", tostring(seconds))
  end
  P.want_function(f, "sim:after")
  local entry = { due = now() + seconds, seconds = seconds }
  local handle = add_timer(f, entry)
  if not entry.in_callback then afters[#afters + 1] = entry end
  return handle
end)
method("at", function(_, time, f)
  P.want_number(time, "sim:at")
  P.want_function(f, "sim:at")
  return add_timer(f, { due = time, fixed = true })
end)

-- The run goes live after timers were last checked at `time`: periods continue, and fixed times before it don't fire
-- again.
function P.resume_timers(time)
  for _, entry in ipairs(timers) do
    if entry.period then
      entry.periods = periods_until(entry, time)
    elseif entry.fixed and time + kTolerance >= entry.due then
      entry.off = true
    end
  end
end

-- Serializes top-level timers of sim:after for the next run: delay, due time, whether it has ended. Failed ones have no
-- due time: they count again, since the edit may have fixed them.
function P.entry.afters()
  local list = {}
  for i, entry in ipairs(afters) do
    list[i] = { entry.seconds, not entry.failed and entry.due, entry.off == true and not entry.failed }
  end
  return P.plain_text(list, "afters", function() end)
end

-- Takes over the timers of the previous run. The n-th timer with a given delay continues the n-th one with that delay:
-- same due time, and no second call if it has fired or was canceled. Others start in this run.
function P.entry.adopt_afters(text)
  local of_delay = {}
  for _, before in ipairs(P.plain_value(text) or {}) do
    local queue = of_delay[before[1]] or { at = 1 }
    of_delay[before[1]] = queue
    queue[#queue + 1] = before
  end
  for _, entry in ipairs(afters) do
    local queue = of_delay[entry.seconds]
    local before = queue and queue[queue.at]
    if before then
      queue.at = queue.at + 1
      entry.due, entry.off = before[2] or entry.due, before[3] or nil
    end
  end
end

-- number of pending timers of callbacks, and how many of them repeat
function P.entry.callback_timers()
  local count, repeating = 0, 0
  for _, entry in ipairs(timers) do
    if not entry.off and entry.in_callback then
      count = count + 1
      if entry.period then repeating = repeating + 1 end
    end
  end
  return count, repeating
end

local function clear(list)
  for i = #list, 1, -1 do list[i] = nil end
end

-- Makes this an earlier run: ends everything registered by the top level, and everything but timers. Returns the number
-- of callback handlers that ended.
function P.entry.retire()
  earlier = true
  local removed = P.remove_handlers()
  for _, list in ipairs { steps, contacts } do
    for _, entry in ipairs(list) do
      if entry.in_callback and not entry.off then removed = removed + 1 end
    end
    clear(list)
  end
  clear(starts)
  clear(afters)
  local remaining = {}
  for _, entry in ipairs(timers) do
    if not entry.off and entry.in_callback then remaining[#remaining + 1] = entry end
  end
  clear(timers)
  for i, entry in ipairs(remaining) do timers[i] = entry end
  return removed
end

-- Timers in `state` are identified in all runs by the number of the run that set them; 0 in a handle is this run.
P.run_number = -1
function P.entry.set_run_number(number) P.run_number = number end
function P.timer(number, run) return T(number, run == P.run_number and 0 or run) end
function P.timer_text(handle) return handle.number_, handle.run_ == 0 and P.run_number or handle.run_ end

-- cancels a timer of this earlier run for another run
function P.entry.cancel_timer(number)
  local entry = timer_of[number]
  if entry then entry.off = true end
end

local timer_methods = {
  cancel = function(handle)
    if not istype(T, handle) then fail("cancel is a method of a timer: write timer:cancel()") end
    P.needs_callback("timer:cancel")
    if handle.run_ ~= 0 then return api.cancel_timer(ctx, handle.run_, handle.number_) end
    local entry = timer_of[handle.number_]
    if not entry or entry.off then return end
    P.journal(timers)
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

local function is_due(entry, time)
  if entry.off then return false end
  if entry.period then return periods_until(entry, time) > entry.periods end
  return time + kTolerance >= entry.due
end

local function run_timers()
  local n = #timers
  if n == 0 then return end
  local time = now()
  for i = 1, n do
    local entry = timers[i]
    local due = is_due(entry, time)
    if entry.period and not entry.off then entry.periods = periods_until(entry, time) end
    if due then
      local ok = guarded(entry.f)
      if not ok then
        entry.failed = true
        api.report(ctx)
      end
      if not (ok and entry.period) then entry.off = true end
    end
  end
  -- remove finished timers, keeping the order of the others
  local remaining = 0
  for i = 1, #timers do
    local entry = timers[i]
    if not entry.off then
      remaining = remaining + 1
      timers[remaining] = entry
    end
  end
  for i = #timers, remaining + 1, -1 do timers[i] = nil end
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
      local part = P.handle_of(number[4], number[5])
      call_all(contacts, part, P.handle_of(slot, generation), impulse, position)
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
  P.report_fallbacks()
end

-- in an earlier run: true if a timer is due; then runs the timers and returns the number of pending ones
function P.entry.timers_due()
  local time = now()
  for _, entry in ipairs(timers) do
    if is_due(entry, time) then return true end
  end
  return false
end
function P.entry.run_timers()
  run_timers()
  return #timers
end
