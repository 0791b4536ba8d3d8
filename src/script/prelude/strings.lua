-- `string` for scripts: an interruptible pattern matcher, texts of bounded size, no memory addresses in texts.
local P = ...
local ffi, api, ctx, fail, describe = P.ffi, P.api, P.ctx, P.fail, P.describe
local native, floor, huge = string, math.floor, math.huge
local native_sub, byte, getmetatable = P.native_sub, string.byte, debug.getmetatable
local match = api.match(ctx)

local kMaxLength = 4 * 2 ^ 20  -- max. length for functions that process a whole text in C

local text_of = tostring
local function check_text(value, name)
  if type(value) == "string" then return value end
  if type(value) == "number" then return text_of(value) end
  fail("string.%s takes text, not %s", name, describe(value))
end
local function check_short(value, name)
  value = check_text(value, name)
  if #value > kMaxLength then fail("string.%s takes texts of up to 4 MB", name) end
  return value
end
local function check_integer(value, missing, name)
  if value == nil then return missing end
  local number = tonumber(value)
  if not number then fail("string.%s takes a number there, not %s", name, describe(value)) end
  if number ~= number then return 0 end
  number = math.max(-2 ^ 31, math.min(2 ^ 31 - 1, number))
  return number < 0 and -floor(-number) or floor(number)
end

-- tables, functions and coroutines are shown without address, which would differ from run to run
function P.show(value)
  local kind = type(value)
  if kind == "table" then
    local meta = getmetatable(value)
    return type(meta) == "table" and rawget(meta, "__tostring") and text_of(value) or "table"
  end
  if kind == "function" or kind == "thread" or kind == "userdata" then return kind end
  return text_of(value)
end
local show = P.show

-- the bytes from offset `first` up to `last`, 0 <= first, last <= #text
local function part(text, first, last)
  if not (first < last) then return "" end
  return native_sub(text, first + 1, last)
end

-- the captures of the last match, from index i on
local function capture(text, i)
  local length = match.length[i]
  if length == -2 then return match.from[i] + 1 end
  if length == -1 then fail("unfinished capture") end
  return part(text, match.from[i], match.from[i] + length)
end
local function captures(text, i, count)
  if i == count - 1 then return capture(text, i) end
  return capture(text, i), captures(text, i + 1, count)
end
local function whole_or_captures(text)
  if match.count == 0 then return part(text, match.start, match["end"]) end
  return captures(text, 0, match.count)
end

local function search(text, pattern, from, anchors, name)
  local found = api.find_match(ctx, text, #text, pattern, #pattern, from, anchors)
  if found < 0 then fail("string.%s: %s", name, P.text()) end
  return found == 1
end

local function start_of(text, init, name)
  init = check_integer(init, 1, name)
  if init < 0 then init = init + #text else init = init - 1 end
  return math.max(0, math.min(#text, init))
end

-- the special characters of a pattern, as in LuaJIT
local function is_pattern(pattern) return native.find(pattern, "[%^%$%*%+%?%.%(%[%%%-]") ~= nil end

local S = {}

function S.find(text, pattern, init, plain)
  text, pattern = check_text(text, "find"), check_text(pattern, "find")
  local from = start_of(text, init, "find")
  if plain or not is_pattern(pattern) then
    local at = api.find_plain(ctx, text, #text, pattern, #pattern, from)
    if at < 0 then return nil end
    return at + 1, at + #pattern
  end
  if not search(text, pattern, from, 1, "find") then return nil end
  local first, last = match.start + 1, match["end"]
  if match.count == 0 then return first, last end
  return first, last, captures(text, 0, match.count)
end

function S.match(text, pattern, init)
  text, pattern = check_text(text, "match"), check_text(pattern, "match")
  if not search(text, pattern, start_of(text, init, "match"), 1, "match") then return nil end
  return whole_or_captures(text)
end

function S.gmatch(text, pattern)
  text, pattern = check_text(text, "gmatch"), check_text(pattern, "gmatch")
  local from = 0
  return function()
    if from > #text or not search(text, pattern, from, 0, "gmatch") then return nil end
    from = match["end"]
    if from == match.start then from = from + 1 end
    return whole_or_captures(text)
  end
end

-- expands % in a replacement text
local function expand(replacement, text)
  local pieces, i = {}, 1
  while i <= #replacement do
    local c = byte(replacement, i)
    if c ~= 37 then
      local stop = native.find(replacement, "%", i, true) or #replacement + 1
      pieces[#pieces + 1] = part(replacement, i - 1, stop - 1)
      i = stop
    else
      c = byte(replacement, i + 1)
      if c == 48 then
        pieces[#pieces + 1] = part(text, match.start, match["end"])
      elseif c and c > 48 and c <= 57 then
        local wanted = c - 49
        if wanted > 0 and wanted >= match.count then fail("string.gsub: invalid capture index") end
        pieces[#pieces + 1] = wanted >= match.count and part(text, match.start, match["end"]) or
          capture(text, wanted)
      else
        pieces[#pieces + 1] = c and native.char(c) or "\0"
      end
      i = i + 2
    end
  end
  return table.concat(pieces)
end

local function replaced(kind, replacement, text)
  if kind == "string" then return expand(replacement, text) end
  local start, stop = match.start, match["end"]  -- saved, because the called function may search itself
  local value
  if kind == "table" then
    value = replacement[match.count == 0 and part(text, start, stop) or capture(text, 0)]
  else
    value = replacement(whole_or_captures(text))
  end
  if not value then return part(text, start, stop) end
  if type(value) ~= "string" and type(value) ~= "number" then
    fail("string.gsub: invalid replacement value (a %s)", type(value))
  end
  return value
end

function S.gsub(text, pattern, replacement, max_count)
  text, pattern = check_text(text, "gsub"), check_text(pattern, "gsub")
  local kind = type(replacement)
  if kind == "number" then kind, replacement = "string", text_of(replacement) end
  if kind ~= "string" and kind ~= "table" and kind ~= "function" then
    fail("string.gsub replaces by text, a table or a function, not %s", describe(replacement))
  end
  if kind == "string" and not native.find(replacement, "%", 1, true) then kind = "plain" end
  max_count = check_integer(max_count, #text + 1, "gsub")
  local pieces, copied, from, count = {}, 0, 0, 0
  while count < max_count and from <= #text and search(text, pattern, from, 1, "gsub") do
    local start, stop = match.start, match["end"]
    count = count + 1
    if start > copied then pieces[#pieces + 1] = part(text, copied, start) end
    pieces[#pieces + 1] = kind == "plain" and replacement or replaced(kind, replacement, text)
    copied = stop
    from = stop > start and stop or stop + 1
    if byte(pattern, 1) == 94 then break end
  end
  if count == 0 then return text, 0 end
  pieces[#pieces + 1] = part(text, copied, #text)
  return table.concat(pieces), count
end

local function plain(...)
  for i = 1, select("#", ...) do
    local kind = type((select(i, ...)))
    if kind ~= "number" and kind ~= "string" and kind ~= "boolean" and kind ~= "nil" then return false end
  end
  return true
end
local function check_format(text, ...)
  if native.find(text, "%%[^%%%a]*p") then
    fail("string.format: %p shows an address, which differs in each run")
  end
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    if type(value) == "string" then check_short(value, "format") end
  end
end
-- LuaJIT 2.1.0-beta3 crashes when it compiles a format with very many parts.
local function format_long(...) return native.format(...) end
jit.off(format_long)
local kLongFormat = 500
function S.format(text, ...)
  text = check_short(text, "format")
  check_format(text, ...)
  local native_format = #text > kLongFormat and format_long or native.format
  if plain(...) then return native_format(text, ...) end
  local values, n = { ... }, select("#", ...)
  for i = 1, n do
    if not plain(values[i]) then values[i] = show(values[i]) end
  end
  return native_format(text, unpack(values, 1, n))
end

function S.rep(text, count, separator)
  text, count = check_text(text, "rep"), check_integer(count, 0, "rep")
  separator = separator ~= nil and check_text(separator, "rep") or ""
  if count <= 0 or #text + #separator == 0 then return "" end
  if (#text + #separator) * count > 8 * 2 ^ 20 then
    fail("string.rep makes texts of up to 8 MB, not %.0f bytes", (#text + #separator) * count)
  end
  if separator == "" then return native.rep(text, count) end
  return native.rep(text, count, separator)
end

for _, name in ipairs { "lower", "upper", "reverse" } do
  local f = native[name]
  S[name] = function(text) return f(check_short(text, name)) end
end

-- separate tables, so that scripts can't modify each other's
function P.make_string()
  local t = { byte = native.byte, char = native.char, len = native.len, sub = native.sub }
  for name, f in pairs(S) do t[name] = f end
  return t
end

-- ("x"):upper() uses a table of its own
local meta = getmetatable("")
meta.__index, meta.__metatable = P.make_string(), "string"
