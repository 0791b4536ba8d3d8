-- A handler that fails is disabled and reported once; its reply is not sent.
-- expect: 7: late
-- messages: 3
-- sent: 0
osc:on("/hit", function()
  osc:send("/early")
  osc:reply("/early") error("late")
end)
