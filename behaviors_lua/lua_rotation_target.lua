-- The built-in `rotation_target`, written in Lua: moves servos and springs towards given angles step by step.
local turn = require "turn"

return behavior {
  doc = "Moves servos and springs towards given angles step by step. (The built-in rotation_target, written in Lua.)",
  params = {
    { "target", vec3(0, 0, 0), min = -1e4, max = 1e4, unit = "rad", doc = "Angles about the joint's axes, in its own order; z is the own axis. Free axes take the shorter way." },
    { "speed", 0.1, min = 0, max = 1e4, unit = "rad", doc = "Maximal lead of the target over the joint's angle, set at each application." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    local target, speed = self.target, self.speed
    for _, motor in ipairs(self.motors) do turn(motor, target, speed) end
  end,
}
