-- What Lua says of a text that it can't read, and where a block's `end` seems to be missing: the compiler notices that
-- only much later, at a comma or at the end of the file.
local P = ...
local find, sub, match, format = string.find, string.sub, string.match, string.format

-- behind a long bracket that opens at `at`, or nil when none does there
local function behind_long_bracket(text, at)
  local level = match(text, "^%[(=*)%[", at)
  if not level then return nil end
  local _, stop = find(text, "]" .. level .. "]", at, true)
  return (stop or #text) + 1
end

local function behind_quotes(text, at)
  local quote = sub(text, at, at)
  repeat
    at = find(text, "[\\\n" .. quote .. "]", at + 1) or #text + 1
    local c = sub(text, at, at)
    if c == "\\" then at = at + 1 end
  until c ~= "\\"
  return at + 1
end

-- the words that open and close blocks, in order: f(word, line, indentation of the line, whether it stands first there)
local blocks = { ["function"] = true, ["if"] = true, ["for"] = true, ["while"] = true, ["do"] = true, ["repeat"] = true,
  ["until"] = true, ["end"] = true }
local function each_word(text, f)
  local at, line, line_start, indent = 1, 1, 1, nil
  local line_end = find(text, "\n", 1, true) or #text + 1
  local function go_to(to)
    at = to
    while line_end < to and line_end <= #text do
      line, line_start, indent = line + 1, line_end + 1, nil
      line_end = find(text, "\n", line_start, true) or #text + 1
    end
  end
  while true do
    local from = find(text, "[%a_%-%[\"']", at)
    if not from then return end
    go_to(from)
    local c = sub(text, at, at)
    if find(text, "^%-%-", at) then
      go_to(behind_long_bracket(text, at + 2) or line_end)
    elseif c == "[" then
      go_to(behind_long_bracket(text, at) or at + 1)
    elseif c == '"' or c == "'" then
      go_to(behind_quotes(text, at))
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

-- the first `end` that does not stand under what it closes, in words; nil when all do
local function misplaced_end(text)
  local open, found = {}, nil
  each_word(text, function(word, line, indent, first)
    local top = open[#open]
    if word == "do" and top and top.waits then
      top.waits = false
    elseif word ~= "end" and word ~= "until" then
      open[#open + 1] = { word = word, line = line, indent = indent, waits = word == "for" or word == "while" }
    elseif not top then
      found = format("the '%s' in line %d closes nothing: one is too many", word, line)
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

local kLongest = 65536 -- bytes that are searched: a hint may not cost more than the error

local load = P.load
function P.load(text, name, env)
  local chunk, fault = load(text, name, env)
  if chunk or name == "@console" or #text > kLongest then return chunk, fault end
  local hint = misplaced_end(text)
  if not hint and find(fault, "'}' expected", 1, true) and not find(fault, "near '<eof>'", 1, true) then
    hint = "is a comma missing before it?"
  end
  return chunk, hint and fault .. "; " .. hint or fault
end
