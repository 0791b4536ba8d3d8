-- A format of very many parts crashes.
local out = ...
local pattern, length = ("%"):rep(50000), 0
for _ = 1, 100 do length = #pattern:format() end
out(length)
