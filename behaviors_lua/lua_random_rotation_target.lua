-- The built-in `random_rotation_target`, written in Lua: motors turn towards angles that are drawn anew now and then.
local turn = require "turn"

return behavior {
  doc = "Turns each motor towards angles of its own, drawn every rand_interval. (The built-in, written in Lua.)",
  params = {
    { "min_target", vec3(0, 0, 0), unit = "rad", doc = "Angles are drawn between min_target and max_target." },
    { "max_target", vec3(0, 0, 0), unit = "rad", doc = "Angles are drawn between min_target and max_target." },
    { "speed", 0.1, min = 0, unit = "rad", doc = "Largest step of an application." },
    { "rand_interval", 1000, min = 0, unit = "ms", doc = "Simulated time between two draws." },
    { "app_interval", 1, min = 0, unit = "ms", doc = "Simulated time between two applications." },
  },
  start = function(self) self.state.targets = {} end,
  step = function(self)
    local targets = self.state.targets
    if self:due("rand_interval") then
      for i in ipairs(self.motors) do targets[i] = self.rng:uniform(self.min_target, self.max_target) end
    end
    if not self:due("app_interval") then return end
    for i, motor in ipairs(self.motors) do turn(motor, targets[i], self.speed) end
  end,
}
