-- The built-in `rotation_target`, written in Lua: motors turn towards one set of angles, a step at each application.
local turn = require "turn"

return behavior {
  doc = "Turns each motor towards a target, a step at each application. (The built-in rotation_target, written in Lua.)",
  params = {
    { "target", vec3(0, 0, 0), unit = "rad", doc = "Angles of the joint to reach, about each axis." },
    { "speed", 0.1, min = 0, unit = "rad", doc = "Largest step of an application." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  step = function(self)
    if not self:due("app_interval") then return end
    for _, motor in ipairs(self.motors) do turn(motor, self.target, self.speed) end
  end,
}
