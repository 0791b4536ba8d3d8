-- The console: evaluates entered texts in the environment of the running scene, as a callback, and completes incomplete
-- texts.
local P = ...
local api, ctx, load, guarded = P.api, P.ctx, P.load, P.guarded
local xpcall, pcall, next, type, rawget = xpcall, pcall, next, type, rawget
local format, istype = string.format, P.ffi.istype
local getmetatable = debug.getmetatable

-- formats values for display: tables up to three levels deep, four hundred values in total
local kMaxDepth, kMaxValues, kMaxKeys = 3, 400, 2000
local show_value

local function before(a, b)
  local s, t = type(a), type(b)
  if s ~= t then return s < t end
  if s == "number" or s == "string" then return a < b end
  return P.show(a) < P.show(b)
end

local function show_key(key)
  if type(key) == "string" then
    return key:find("^[%a_][%w_]*$") and key or format("[%q]", key)
  end
  return "[" .. P.show(key) .. "]"
end

local function show_table(t, depth, budget)
  if depth >= kMaxDepth then return "{ … }" end
  local list, keys, last = {}, {}, 0
  while rawget(t, last + 1) ~= nil and budget.left > 0 do
    last = last + 1
    list[last] = show_value(rawget(t, last), depth + 1, budget)
  end
  for key in next, t do
    if not (type(key) == "number" and key >= 1 and key <= last and key % 1 == 0) then keys[#keys + 1] = key end
    if #keys == kMaxKeys then break end
  end
  table.sort(keys, before)
  for _, key in ipairs(keys) do
    if budget.left <= 0 then
      list[#list + 1] = "…"
      break
    end
    list[#list + 1] = show_key(key) .. " = " .. show_value(rawget(t, key), depth + 1, budget)
  end
  return #list == 0 and "{}" or "{ " .. table.concat(list, ", ") .. " }"
end

function show_value(value, depth, budget)
  budget.left = budget.left - 1
  local kind = type(value)
  if kind == "string" then return depth == 0 and value or (format("%q", value):gsub("\\\n", "\\n")) end
  if istype(P.L, value) then return show_table(P.items_of(value), depth, budget) end
  if kind ~= "table" then return P.show(value) end
  local meta = getmetatable(value)
  if type(meta) == "table" and rawget(meta, "__tostring") then return P.show(value) end
  return show_table(value, depth, budget)
end

local function show_all(...)
  local count = select("#", ...)
  if count == 0 then return nil end
  local list = { ... }
  for i = 1, count do list[i] = show_value(list[i], 0, { left = kMaxValues }) end
  return table.concat(list, "\t")
end

-- true if a text that Lua can't read may become a valid chunk with more lines
local function is_incomplete(message)
  return message:find("near '<eof>'", 1, true) and not message:find("unfinished string near", 1, true) and
    not message:find("'=' expected", 1, true)
end

-- An expression is evaluated after a nil: alone it would be a tail call, and an error in it would have no place.
local kExpression = "return nil, "
local function call_and_show(chunk, skipped) return show_all(select(1 + skipped, chunk())) end

-- returns kind and text of an Evaluation (base/evaluation.h)
function P.exports.evaluate(text)
  if not P.env then return "error", "no scene has run yet" end
  text = text:gsub("^%s*=", "")
  P.sources.console = text
  local chunk, fault = load(kExpression .. text, "@console", P.env)
  local skipped = 1
  if not chunk then
    skipped = 0
    local as_value = fault
    chunk, fault = load(text, "@console", P.env)
    if not chunk then
      if is_incomplete(as_value) or is_incomplete(fault) then return "incomplete", "" end
      return "error", P.handler(fault).text
    end
  end
  local result
  local success = guarded(function() result = call_and_show(chunk, skipped) end)
  P.sources.console = true -- functions it leaves behind may fail later, when `console` has another text
  if not success then
    api.fault(ctx)
    return "error", P.text()
  end
  return result and "value" or "done", result or ""
end

-- Completion. Evaluates a chain such as sim:body("arm").root without running code of the scene: reads members, and
-- calls only those methods that look up an object.
local lookups = { body = true, find_body = true, part = true, joint = true, motor = true, behavior = true,
  group_behavior = true }
local class_lists = { bodies = true, parts = true, joints = true, motors = true, behaviors = true }

local function member_of(value, key)
  local class = P.class_of(value)
  if class then
    local ok, found = pcall(class.getters[key] or error, value)
    return ok and found or nil
  end
  if istype(P.L, value) then return P.items_of(value)[key] end
  if value == P.params then
    local ok, found = pcall(function() return value[key] end)
    return ok and found or nil
  end
  return type(value) == "table" and rawget(value, key) or nil
end

local function look_up(value, name, argument)
  local class = P.class_of(value)
  if not (class and lookups[name] and class.methods[name]) then return nil end
  local ok, found = pcall(class.methods[name], value, argument)
  return ok and found or nil
end

-- the contents of the quotes at the start of a text, and the rest
local function quoted(text)
  local quote = text:match("^[\"']")
  local at = 2
  while quote and at <= #text do
    local c = text:sub(at, at)
    if c == quote then return (text:sub(2, at - 1):gsub("\\(.)", "%1")), text:sub(at + 1) end
    at = at + (c == "\\" and 2 or 1)
  end
end

-- the key in brackets, or the argument in parentheses, at the start of a text (text or number), and the rest
local function enclosed(text, open, close)
  local inside = text:match("^%" .. open .. "%s*(.*)$")
  if not inside then return nil end
  local key, after = quoted(inside)
  if not key then
    key, after = inside:match("^(%-?%d+)(.*)$")
    key = tonumber(key)
  end
  after = after and after:match("^%s*%" .. close .. "(.*)$")
  return after and key, after
end

-- the value of a chain, or nil if unknown
local function follow(chain)
  local name, rest = chain:match("^([%a_][%w_]*)(.*)$")
  local value = name and rawget(P.env, name)
  while value ~= nil and rest ~= "" do
    local key, after = rest:match("^%.([%a_][%w_]*)(.*)$")
    if not key then key, after = enclosed(rest, "[", "]") end
    if key then
      value, rest = member_of(value, key), after
    else
      local method, argument
      method, after = rest:match("^:([%a_][%w_]*)(.*)$")
      if not method then return nil end
      local call = after
      argument, after = enclosed(call, "(", ")")
      if not argument then argument, after = quoted(call) end
      if not argument then return nil end
      value, rest = look_up(value, method, argument), after
    end
  end
  return value
end

-- position of the opening quote for the closing one at `at`; 0 or less if there is none
local function quote_before(text, at)
  local quote = text:sub(at, at)
  repeat at = at - 1 until at <= 0 or text:sub(at, at) == quote and text:sub(at - 1, at - 1) ~= "\\"
  return at
end

-- the chain at the end of a text: backwards over names, dots, colons, quotes and complete brackets
local function chain_at_end(text)
  local at = #text
  while at > 0 do
    local c = text:sub(at, at)
    if c == ")" or c == "]" then
      local open = c == ")" and "(" or "["
      repeat at = at - 1 until not text:find("^%s", at)
      if text:find("^[\"']", at) then at = quote_before(text, at) end
      while at > 0 and text:sub(at, at) ~= open do at = at - 1 end
    elseif c == '"' or c == "'" then
      at = quote_before(text, at)
    elseif not c:find("[%w_.:]") then
      break
    end
    at = at - 1
  end
  return text:sub(math.max(at, 0) + 1)
end

local function add_keys(words, t)
  for key in next, t do
    if type(key) == "string" then words[key] = true end
  end
end

local function add_members(words, class, separator)
  add_keys(words, separator == ":" and class.methods or class.getters)
  if separator ~= ":" then return end
  for key in next, class.getters do
    if class_lists[key] then words[key] = true end
  end
end

local function members(value, separator)
  local words, class = {}, P.class_of(value)
  if class then
    add_members(words, class, separator)
  elseif value == P.osc then
    for _, key in ipairs(P.osc_members) do words[key] = true end
  elseif value == P.presets then
    for _, key in ipairs(P.preset_members) do words[key] = true end
  elseif value == P.params then
    add_keys(words, P.parameter_names())
  elseif type(value) == "cdata" then
    add_keys(words, P.value_members[tostring(P.ffi.typeof(value)):match("struct (%w+)")] or {})
  elseif type(value) == "table" then
    add_keys(words, value)
  elseif type(value) == "string" then
    add_keys(words, rawget(P.env, "string") or {})
  elseif value == nil then
    -- unknown object: the members of all classes
    for _, each in next, P.classes do add_members(words, each, separator) end
  end
  return words
end

-- the part of a text inside a string that is still open, else nil
local function open_string(text)
  local quote, from
  local i = 1
  while i <= #text do
    local c = text:sub(i, i)
    if quote and c == "\\" then
      i = i + 1
    elseif quote and (c == quote or c == "\n") then
      quote = nil
    elseif not quote and (c == '"' or c == "'") then
      quote, from = c, i + 1
    end
    i = i + 1
  end
  return quote and text:sub(from)
end

local function object_names()
  local words = {}
  local function add(list)
    for _, item in ipairs(P.items_of(list)) do words[P.names[item]] = true end
  end
  for _, kind in ipairs { 0, 4, 6 } do add(P.list_of(P.sim, kind)) end
  for _, body in ipairs(P.items_of(P.list_of(P.sim, 0))) do
    for _, kind in ipairs { 1, 2, 3, 5 } do add(P.list_of(body, kind)) end
  end
  return words
end

-- completions for the end of a text, and the number of bytes that they replace
local kMaxWords = 500
local function complete(text)
  local word, words = open_string(text), {}
  if word then
    words = object_names()
  else
    word = text:match("[%w_]*$")
    local separator = text:sub(-#word - 1, -#word - 1)
    if separator == "." or separator == ":" then
      words = members(follow(chain_at_end(text:sub(1, -#word - 2))), separator)
    else
      add_keys(words, P.env)
    end
  end
  local list = {}
  for _, each in ipairs(P.sorted_keys(words)) do
    if #list < kMaxWords and each:sub(1, #word) == word then list[#list + 1] = each end
  end
  return table.concat(list, "\n"), #word
end

function P.exports.complete(text)
  if not P.env then return "names", "", 0 end
  local ok, list, word = xpcall(complete, P.handler, text)
  if not ok then return "names", "", 0 end
  return "names", list, word
end
