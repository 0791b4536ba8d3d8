-- The built-in `rotation_target`, written in Lua: leads servos and springs towards angles, a step at a time.
local turn = require "turn"

return behavior {
  doc = "Leads servos and springs towards angles, a step at a time. (The built-in rotation_target, written in Lua.)",
  params = {
    { "target", vec3(0, 0, 0), min = -1e4, max = 1e4, unit = "rad", doc = "About the joint's axes, in its own order; z is the own axis. On a free axis it goes the shorter way round." },
    { "speed", 0.1, min = 0, max = 1e4, unit = "rad", doc = "How far ahead of the joint the servo or spring is set, at each application." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one application to the next; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local target, speed = self.target, self.speed
    for _, motor in ipairs(self.motors) do turn(motor, target, speed) end
  end,
}
