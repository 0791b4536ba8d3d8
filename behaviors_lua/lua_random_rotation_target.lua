-- The built-in `random_rotation_target`, written in Lua: leads each servo and spring towards angles of its own that are
-- drawn anew from time to time.
local turn = require "turn"

return behavior {
  doc = "Leads each servo and spring towards angles of its own, drawn anew from time to time. (The built-in, written in Lua.)",
  params = {
    { "min_target", vec3(0, 0, 0), min = -1e4, max = 1e4, unit = "rad", doc = "Angles are drawn from these, about the joint's axes," },
    { "max_target", vec3(0, 0, 0), min = -1e4, max = 1e4, unit = "rad", doc = "to these. On free axes it goes the shorter way round." },
    { "speed", 0.1, min = 0, max = 1e4, unit = "rad", doc = "How far ahead of the joint the servo or spring is set, at each application." },
    { "rand_interval", 1000, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one random draw to the next." },
    { "app_interval", 1, min = 0, max = 1e9, unit = "ms", doc = "Simulated time from one application to the next; shorter than a tick: every tick." },
  },
  start = function(self) self.state.x, self.state.y, self.state.z = {}, {}, {} end,
  step = function(self)
    -- three lists of numbers are read faster than one of vectors
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
