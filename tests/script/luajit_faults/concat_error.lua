-- An error of `..` in a loop is lost while the loop is compiled.
local out = ...
local object = setmetatable({}, { __concat = function() return "" end })
local function join()
  local count = 0
  while count < 1 do
    count = count + 1
    local _ = {} .. (object .. object)
  end
end
local lost = 0
for _ = 1, 300 do
  if pcall(join) then lost = lost + 1 end
end
out(lost)
