-- Callbacks of a scene: start, tick, contacts, timers. Each is a guarded call; one that fails is disabled and reported.
local P = ...
local ffi, api, ctx, answer, guarded = P.ffi, P.api, P.ctx, P.answer, P.guarded
local fail, istype, floor = P.fail, P.ffi.istype, math.floor
local method = P.sim_method
local number = answer.number

-- Undo log of registrations, used if the call fails. Each record has a list and its previous length; that of a
-- canceled timer also has the timer to reactivate. Records of earlier calls are obsolete.
local journal = {}
function P.journal(list)
  if #journal > 0 and journal[1].call ~= answer.call then journal = {} end
  journal[#journal + 1] = { call = answer.call, list = list, count = #list }
end
-- True in an earlier run: its file has been saved since, so only timers that its callbacks have created continue.
local earlier = false

-- returns true in an earlier run, which can no longer register anything (reported once for each line)
function P.is_earlier_run(subject)
  if earlier then
    P.warn_once(subject ..
      " is ignored: this function belongs to a run before the last save, of which only timers continue")
  end
  return earlier
end

local function add(list, callback, subject)
  if P.is_earlier_run(subject) then return end
  P.journal(list)
  callback.in_callback = answer.top_level == 0
  list[#list + 1] = callback
end
P.on_failure[#P.on_failure + 1] = function()
  for i = #journal, 1, -1 do
    local record = journal[i]
    if record.call == answer.call then
      if record.timer then record.timer.disabled = nil end
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
    local callback = list[i]
    if not callback.disabled then
      if not guarded(callback.f, a, b, c, d) then
        callback.disabled = true
        api.report(ctx)
      end
    end
  end
end
jit.off(call_all)

local starts, steps, beats, timers = {}, {}, {}, {}
local contacts = { [0] = {}, {}, {} }  -- by phase: begin, stay, end

method("on_start", function(_, f)
  P.check_function(f, "sim:on_start")
  add(starts, { f = f }, "sim:on_start")
end)
method("on_step", function(_, f)
  P.check_function(f, "sim:on_step")
  add(steps, { f = f }, "sim:on_step")
end)
method("on_beat", function(_, f, every)
  P.check_function(f, "sim:on_beat")
  every = every == nil and 1 or P.check_number(every, "sim:on_beat")
  if not (every >= 1 / 64 and every <= 4096) then
    fail("sim:on_beat takes 1/64 to 4096 beats, not %s", P.describe(every))
  end
  add(beats, { f = f, every = every }, "sim:on_beat")
end)
for phase, name in pairs { [0] = "on_contact", "on_contact_stay", "on_contact_end" } do
  local subject = "sim:" .. name
  method(name, function(_, f)
    P.check_function(f, subject)
    add(contacts[phase], { f = f }, subject)
  end)
end

local zones = { [0] = {}, {} }  -- by event: leave, enter
for enters, name in pairs { [0] = "on_zone_leave", "on_zone_enter" } do
  local subject = "sim:" .. name
  method(name, function(_, f)
    P.check_function(f, subject)
    add(zones[enters], { f = f }, subject)
  end)
end

-- Timers. A sum of time steps misses a multiple by a few bits, so a timer is due one nanosecond early.
local kTolerance = 1e-9
local T = ffi.typeof("timer")
local timer_of = setmetatable({}, { __mode = "v" })
local timer_count = 0
-- the timers that sim:after has created at the top level, in this order, including finished ones; the next run
-- continues them
local delayed_timers = {}

local function now() return P.sim.time end

local function add_timer(f, timer)
  timer_count = timer_count + 1
  timer.f, timer.handle = f, T(timer_count, 0)
  timer.in_callback = answer.top_level == 0
  timer_of[timer_count] = timer
  P.journal(timers)
  timers[#timers + 1] = timer
  return timer.handle
end

local function periods_until(timer, time) return floor((time + kTolerance) / timer.period) end

method("every", function(_, seconds, f)
  if P.check_number(seconds, "sim:every") <= 0 then
    fail("sim:every takes seconds above 0, not %s", tostring(seconds))
  end
  P.check_function(f, "sim:every")
  local timer = { period = seconds }
  timer.periods = periods_until(timer, now())
  return add_timer(f, timer)
end)
method("after", function(_, seconds, f)
  if P.check_number(seconds, "sim:after") < 0 then
    fail("sim:after takes seconds of 0 or more, not %s", tostring(seconds))
  end
  P.check_function(f, "sim:after")
  local timer = { due = now() + seconds, seconds = seconds }
  local handle = add_timer(f, timer)
  if not timer.in_callback then delayed_timers[#delayed_timers + 1] = timer end
  return handle
end)
method("at", function(_, time, f)
  P.check_number(time, "sim:at")
  P.check_function(f, "sim:at")
  return add_timer(f, { due = time, fixed = true })
end)

-- Called when this run goes live. The previous run last checked its timers at `time`: timers of sim:every keep their
-- phase, and a timer of sim:at that was due by then doesn't fire again.
function P.resume_timers(time)
  for _, timer in ipairs(timers) do
    if timer.period then
      timer.periods = periods_until(timer, time)
    elseif timer.fixed and time + kTolerance >= timer.due then
      timer.disabled = true
    end
  end
end

-- Serializes the top level's timers of sim:after for the next run: delay, due time, whether it has ended. A failed
-- timer is saved without a due time: it starts again, since the edit may have fixed it.
function P.exports.delayed_timers()
  local list = {}
  for i, timer in ipairs(delayed_timers) do
    list[i] = { timer.seconds, not timer.failed and timer.due, timer.disabled == true and not timer.failed }
  end
  return P.plain_text(list, "delayed timers", function() end)
end

-- Continues the delayed timers of the previous run. The n-th timer with a given delay continues the n-th one with that
-- delay: same due time, and no second call if it has fired or was canceled. Others start in this run.
function P.exports.adopt_delayed_timers(text)
  local of_delay = {}
  for _, before in ipairs(P.plain_value(text) or {}) do
    local queue = of_delay[before[1]] or { at = 1 }
    of_delay[before[1]] = queue
    queue[#queue + 1] = before
  end
  for _, timer in ipairs(delayed_timers) do
    local queue = of_delay[timer.seconds]
    local before = queue and queue[queue.at]
    if before then
      queue.at = queue.at + 1
      timer.due, timer.disabled = before[2] or timer.due, before[3] or nil
    end
  end
end

-- returns the number of pending timers that callbacks have created, and how many of them repeat
function P.exports.callback_timers()
  local count, repeating = 0, 0
  for _, timer in ipairs(timers) do
    if not timer.disabled and timer.in_callback then
      count = count + 1
      if timer.period then repeating = repeating + 1 end
    end
  end
  return count, repeating
end

local function clear(list)
  for i = #list, 1, -1 do list[i] = nil end
end

-- Makes this an earlier run: ends everything registered by the top level, and everything but timers. Returns the number
-- of ended handlers that callbacks have registered.
function P.exports.retire()
  earlier = true
  local removed = P.remove_handlers()
  for _, list in ipairs { steps, beats, contacts[0], contacts[1], contacts[2], zones[0], zones[1] } do
    for _, callback in ipairs(list) do
      if callback.in_callback and not callback.disabled then removed = removed + 1 end
    end
    clear(list)
  end
  clear(starts)
  clear(delayed_timers)
  local remaining = {}
  for _, timer in ipairs(timers) do
    if not timer.disabled and timer.in_callback then remaining[#remaining + 1] = timer end
  end
  clear(timers)
  for i, timer in ipairs(remaining) do timers[i] = timer end
  return removed
end

-- A timer handle has the timer's number and the number of the run that created it (0: this run), so that each run can
-- identify a timer in `state`.
P.run_number = -1
function P.exports.set_run_number(number) P.run_number = number end
function P.timer(number, run) return T(number, run == P.run_number and 0 or run) end
function P.timer_text(handle) return handle.number_, handle.run_ == 0 and P.run_number or handle.run_ end

-- in an earlier run: cancels one of its timers, at the request of another run
function P.exports.cancel_timer(number)
  local timer = timer_of[number]
  if timer then timer.disabled = true end
end

local timer_methods = {
  cancel = function(handle)
    if not istype(T, handle) then fail("cancel is a method of a timer: write timer:cancel()") end
    P.needs_callback("timer:cancel")
    if handle.run_ ~= 0 then return api.cancel_timer(ctx, handle.run_, handle.number_) end
    local timer = timer_of[handle.number_]
    if not timer or timer.disabled then return end
    P.journal(timers)
    journal[#journal].timer = timer
    timer.disabled = true
  end,
}
ffi.metatype(T, {
  __index = function(_, key)
    return timer_methods[key] or fail("a timer has no member '%s'%s", tostring(key), P.hint(key, { "cancel" }))
  end,
  __newindex = function() fail("a timer has nothing to set") end,
  __tostring = function() return "timer" end,
})

local function is_due(timer, time)
  if timer.disabled then return false end
  if timer.period then return periods_until(timer, time) > timer.periods end
  return time + kTolerance >= timer.due
end

local function run_timers()
  local n = #timers
  if n == 0 then return end
  local time = now()
  for i = 1, n do
    local timer = timers[i]
    local due = is_due(timer, time)
    if timer.period and not timer.disabled then timer.periods = periods_until(timer, time) end
    if due then
      local ok = guarded(timer.f)
      if not ok then
        timer.failed = true
        api.report(ctx)
      end
      if not (ok and timer.period) then timer.disabled = true end
    end
  end
  -- remove finished timers, keeping the order of the others
  local remaining = 0
  for i = 1, #timers do
    local timer = timers[i]
    if not timer.disabled then
      remaining = remaining + 1
      timers[remaining] = timer
    end
  end
  for i = #timers, remaining + 1, -1 do timers[i] = nil end
end
jit.off(run_timers)

local function run_beats()
  for i = 1, #beats do
    local callback = beats[i]
    local reached = not callback.disabled and P.beat_reached(callback.every)
    if reached and not guarded(callback.f, reached * callback.every) then
      callback.disabled = true
      api.report(ctx)
    end
  end
end
jit.off(run_beats)

local function run_contacts(phase)
  local list = contacts[phase]
  if #list == 0 then return end
  local i = 0
  while true do
    local code = api.contact(ctx, phase, i)
    if code == -1 then return end
    if code == 0 then
      local impulse, position = number[0], P.V(number[1], number[2], number[3])
      local slot, generation = number[6], number[7]
      local part = P.handle_of(number[4], number[5])
      call_all(list, part, P.handle_of(slot, generation), impulse, position)
    end
    i = i + 1
  end
end

local function run_zones(enters)
  local list = zones[enters]
  if #list == 0 then return end
  local i = 0
  while true do
    local code = api.zone_event(ctx, enters, i)
    if code == -1 then return end
    if code == 0 then
      local slot, generation = number[2], number[3]
      local zone = P.handle_of(number[0], number[1])
      call_all(list, zone, P.handle_of(slot, generation))
    end
    i = i + 1
  end
end

function P.exports.start()
  call_all(starts)
end
function P.exports.tick(dt)
  run_timers()
  for phase = 0, 2 do run_contacts(phase) end
  run_zones(1)
  run_zones(0)
  run_beats()
  call_all(steps, dt)
  if P.sample_row then P.sample_row() end
  P.report_fallbacks()
end

-- earlier runs: returns true if a timer is due
function P.exports.timers_due()
  local time = now()
  for _, timer in ipairs(timers) do
    if is_due(timer, time) then return true end
  end
  return false
end
-- earlier runs: runs the due timers and returns the number of pending ones
function P.exports.run_timers()
  run_timers()
  return #timers
end
