-- A handler that errs tries again with the next message; what it answered is not sent.
-- expect: 9: late
-- expect: 9: late
-- expect: 9: late
-- messages: 3
-- sent: 0
osc:on("/hit", function()
  osc:send("/early")
  osc:reply("/early") error("late")
end)
