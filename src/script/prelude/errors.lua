-- Error messages: "file:line: message", the source line, the stack traceback of the scripts.
local P = ...
local api, ctx = P.api, P.ctx
local getinfo, format, sub, find = debug.getinfo, string.format, P.native_sub, string.find
jit.off(true, true)  -- because of native_sub; and a stack overflow leaves little stack space

-- text of each script by its name in messages; true if it is no longer available
local sources = {}
P.sources = sources

local function source_line(file, line)
  local text, at = sources[file], 1
  if type(text) ~= "string" then return nil end
  for _ = 2, line do
    local stop = find(text, "\n", at, true)
    if not stop then return nil end
    at = stop + 1
  end
  return (sub(text, at, (find(text, "\n", at, true) or #text + 1) - 1):gsub("\r", ""))
end

-- Lua truncates long names at the front: "...ts/arms.lua"
local function full_name(name)
  if sources[name] then return name end
  if sub(name, 1, 3) ~= "..." then return nil end
  for _, known in ipairs(P.sorted_keys(sources)) do
    if sub(known, 3 - #name) == sub(name, 4) then return known end
  end
end

-- splits a message into file, line and the rest
local function place_in(message)
  local from, to, name, line = find(message, "^(.-):(%d+): ")
  if not from then return nil, nil, message end
  local file = full_name(name)
  if file then return file, tonumber(line), sub(message, to + 1) end
  -- an error raised by Lua inside a prelude file is attributed to the script that called it
  if find(name, "^limber ") then return nil, nil, sub(message, to + 1) end
  return nil, nil, message
end

local function explain(message)
  if find(message, "^attempt to call method '.-' %(a %a+ value%)") and not find(message, "nil value") then
    return message .. "; use a dot for members, a colon only for methods"
  end
  if message == "attempt to call field 'randomseed' (a nil value)" then
    return "math.randomseed is not available; sim.seed (or --seed) seeds every generator of a scene"
  end
  if message == "attempt to write to constant location" then
    return "this member is read-only; of a vec3 or quat assign the whole value"
  end
  return message
end

local function traceback(level)
  local lines, shown = {}, 0
  for l = level, 200 do
    local info = getinfo(l, "Sln")
    if not info then break end
    if sub(info.source, 1, 1) == "@" then
      shown = shown + 1
      if shown > 20 then
        lines[#lines + 1] = "  …"
        break
      end
      local location = info.what == "main" and "the main chunk" or info.name and "function '" .. info.name .. "'" or
        format("the function of line %d", info.linedefined)
      lines[#lines + 1] = format("  %s:%d: in %s", sub(info.source, 2), info.currentline, location)
    end
  end
  return lines
end

-- messages have a bounded length, because they are processed where no script can be stopped
local function shortened(text, max_length) return #text > max_length and sub(text, 1, max_length) .. "…" or text end

local function fault_of(file, line, message, trace)
  local text = message
  if file then
    text = format("%s:%d: %s", file, line, message)
    local source = source_line(file, line)
    if source then text = format("%s\n  %d | %s", text, line, shortened(source, 200)) end
  end
  if #trace > 0 then text = text .. "\nstack traceback:\n" .. table.concat(trace, "\n") end
  return { file = file or P.main or "", line = line or 0, text = text }  -- 0: set by the guard
end

-- The message handler of every guarded call. The thrown value can have any type; its __tostring is never called.
function P.handler(thrown)
  if api.stopped(ctx) ~= 0 then return P.stopped_fault(traceback(3)) end
  if type(thrown) ~= "string" then
    thrown = type(thrown) == "number" and tostring(thrown) or format("an error that is not text but a %s", type(thrown))
  end
  local file, line, message = place_in(shortened(thrown, 4000))
  if not file then file, line = P.script_place(3) end
  return fault_of(file, line, explain(message), traceback(3))
end

-- the fault of a call that was stopped; needed if the call has caught the error itself
function P.stopped_fault(trace)
  api.stopped(ctx)
  local file, line = P.text(), tonumber(P.answer.number[0])
  api.stop_text(ctx)
  return fault_of(#file > 0 and file or nil, line, P.text(), trace or {})
end

P.exports.handler, P.exports.stopped_fault = P.handler, P.stopped_fault
function P.exports.failed()
  for _, f in ipairs(P.on_failure) do f() end
end
