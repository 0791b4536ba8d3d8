-- Extends Lua's syntax errors with the place where an `end` is probably missing: the compiler detects that only much
-- later, at a comma or at the end of the file.
local P = ...
local find, sub, match, format = string.find, string.sub, string.match, string.format

-- position after a long bracket that opens at `at`, or nil if there is none
local function end_of_long_bracket(text, at)
  local level = match(text, "^%[(=*)%[", at)
  if not level then return nil end
  local _, stop = find(text, "]" .. level .. "]", at, true)
  return (stop or #text) + 1
end

local function end_of_quotes(text, at)
  local quote = sub(text, at, at)
  repeat
    at = find(text, "[\\\n" .. quote .. "]", at + 1) or #text + 1
    local c = sub(text, at, at)
    if c == "\\" then at = at + 1 end
  until c ~= "\\"
  return at + 1
end

-- Calls f for the words that open and close blocks, in order: f(word, line, indentation of the line, whether the word
-- is the first in its line). Stops when f returns true.
local blocks = { ["function"] = true, ["if"] = true, ["for"] = true, ["while"] = true, ["do"] = true, ["repeat"] = true,
  ["until"] = true, ["end"] = true }
local function each_word(text, f)
  local at, line, line_start, indent = 1, 1, 1, nil
  local line_end = find(text, "\n", 1, true) or #text + 1
  local function advance_to(to)
    at = to
    while line_end < to and line_end <= #text do
      line, line_start, indent = line + 1, line_end + 1, nil
      line_end = find(text, "\n", line_start, true) or #text + 1
    end
  end
  while true do
    local from = find(text, "[%a_%-%[\"']", at)
    if not from then return end
    advance_to(from)
    local c = sub(text, at, at)
    if find(text, "^%-%-", at) then
      advance_to(end_of_long_bracket(text, at + 2) or line_end)
    elseif c == "[" then
      advance_to(end_of_long_bracket(text, at) or at + 1)
    elseif c == '"' or c == "'" then
      advance_to(end_of_quotes(text, at))
    elseif c == "-" then
      at = at + 1
    else
      local word = match(text, "^[%w_]+", at)
      if blocks[word] then
        indent = indent or #match(text, "^[ \t]*", line_start)
        if f(word, line, indent, line_start + indent == at) then return end
      end
      at = at + #word
    end
  end
end

-- describes the first `end` that is indented less than the word it closes; nil if there is none
local function misplaced_end(text)
  local open, found = {}, nil
  each_word(text, function(word, line, indent, first)
    local top = open[#open]
    if word == "do" and top and top.awaits_do then
      top.awaits_do = false
    elseif word ~= "end" and word ~= "until" then
      open[#open + 1] = { word = word, line = line, indent = indent, awaits_do = word == "for" or word == "while" }
    elseif not top then
      found = format("the '%s' in line %d closes no block", word, line)
    else
      open[#open] = nil
      if first and line > top.line and indent < top.indent then
        found = format("the '%s' in line %d closes the '%s' of line %d: is an 'end' missing between them?", word, line,
          top.word, top.line)
      end
    end
    return found
  end)
  return found
end

local kMaxSearchedBytes = 65536 -- bytes; in longer texts the search would take longer than the compilation

local load = P.load
function P.load(text, name, env)
  local chunk, fault = load(text, name, env)
  if chunk or name == "@console" or #text > kMaxSearchedBytes then return chunk, fault end
  local hint = misplaced_end(text)
  if not hint and find(fault, "'}' expected", 1, true) and not find(fault, "near '<eof>'", 1, true) then
    hint = "is a comma missing before it?"
  end
  return chunk, hint and fault .. "; " .. hint or fault
end
