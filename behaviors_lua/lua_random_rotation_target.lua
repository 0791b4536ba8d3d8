-- The built-in `random_rotation_target`, written in Lua: moves each servo and spring towards random angles, which
-- change at regular intervals.
local turn = require "turn"

return behavior {
  doc = "Moves each servo and spring towards random angles, which change at regular intervals. (The built-in, written in Lua.)",
  params = {
    { "min_target", vec3(0, 0, 0), min = -1e4, max = 1e4, unit = "rad", doc = "Lower bounds of the random angles about the joint's axes." },
    { "max_target", vec3(0, 0, 0), min = -1e4, max = 1e4, unit = "rad", doc = "Upper bounds of the random angles. Free axes take the shorter way." },
    { "speed", 0.1, min = 0, max = 1e4, unit = "rad", doc = "Maximal lead of the target over the joint's angle, set at each application." },
    { "rand_interval", 1000, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between random draws." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time between applications; shorter than a tick: every tick." },
  },
  start = function(self) self.state.x, self.state.y, self.state.z = {}, {}, {} end,
  step = function(self)
    -- three lists of numbers are faster to read than one of vectors
    local x, y, z = self.state.x, self.state.y, self.state.z
    if self:due("rand_interval") then
      for i in ipairs(self.motors) do
        local target = self.rng:uniform(self.min_target, self.max_target)
        x[i], y[i], z[i] = target.x, target.y, target.z
      end
    end
    if not self:due("app_interval") then return end
    local speed = self.speed
    for i, motor in ipairs(self.motors) do turn(motor, vec3(x[i], y[i], z[i]), speed) end
  end,
}
