-- movement_quality: one of five qualities of movement, with a morph from each to the next.
--
--   arm:add_behavior("movement_quality", "quality", { quality = "fluidity", morph = 4 })
local turn = require "turn"

-- force: share of `force` on the last part. lead: largest lead of a motor's target over its angle, rad. interval: between
-- two random draws, s. motors: number of motors from the root that it moves, by default all.
local qualities = {
  none = {},
  levitation = { force = 1, interval = 5 },
  particles = { force = 1, interval = 0.3 },
  fluidity = { lead = 0.1, interval = 1 },
  staccato = { lead = 1.4, interval = 2 },
  thrusting = { lead = 2.8, interval = 1.5, motors = 2 },
}
local names = { "none", "levitation", "particles", "fluidity", "staccato", "thrusting" }

-- draws a new direction or new angles of a quality when its interval is over
local function draw(self, name, quality)
  local s = self.state
  if not quality.interval or self.time < (s.due[name] or 0) then return end
  s.due[name] = self.time + quality.interval / self.pace
  if quality.force then
    local direction = self.rng:uniform(vec3(-1, -1, -1), vec3(1, 1, 1))
    local length = direction:length()
    s.directions[name] = length > 0 and direction / length or vec3(0, 0, 1)
    return
  end
  local angles = s.angles[name] or {}
  for i = 1, #self.motors do angles[i] = self.rng:uniform(-1, 1) end
  s.angles[name] = angles
end

-- moves the share of the chosen quality towards 1, and those of the others towards 0
local function morph(self, dt)
  local shares = self.state.shares
  for _, name in ipairs(names) do
    local wanted, share = name == self.quality and 1 or 0, shares[name] or 0
    local step = self.morph > 0 and dt / self.morph or 1
    shares[name] = share + math.max(-step, math.min(step, wanted - share))
  end
  return shares
end

local function push(self, shares)
  local part = self.parts[#self.parts]
  if not part then return end
  local sum = vec3()
  for _, name in ipairs(names) do
    local direction = self.state.directions[name]
    if direction then sum = sum + direction * (shares[name] * qualities[name].force * self.force) end
  end
  part:apply_force(sum)
end

-- the mean of the angles and leads of the qualities that move this motor, weighted by their shares
local function move(self, motor, i, shares)
  local weight, angle, lead = 0, 0, 0
  for _, name in ipairs(names) do
    local quality, angles = qualities[name], self.state.angles[name]
    if angles and angles[i] and i <= (quality.motors or math.huge) then
      local share = shares[name]
      weight, angle, lead = weight + share, angle + share * angles[i], lead + share * quality.lead
    end
  end
  if weight > 0 then turn(motor, vec3(0, 0, self.reach * angle / weight), lead / weight) end
end

return behavior {
  doc = "One of five qualities of movement; a change morphs from the present one to the new one.",
  params = {
    { "quality", "levitation", choices = names, doc = "Floating, trembling, flowing, in jerks, or in thrusts from the root." },
    { "morph", 2, min = 0, max = 60, unit = "s", doc = "Duration of the morph to a new quality." },
    { "force", 1, min = 0, max = 1e4, unit = "N", doc = "Force on the last part: levitation, particles." },
    { "reach", 1.4, min = 0, max = 3.14, unit = "rad", doc = "Largest angle of the motors: fluidity, staccato, thrusting." },
    { "pace", 1, min = 0.05, max = 20, doc = "Factor of the rate at which directions and angles change." },
  },
  start = function(self)
    local s = self.state
    s.shares, s.due, s.directions, s.angles = { [self.quality] = 1 }, {}, {}, {}
  end,
  step = function(self, dt)
    for _, name in ipairs(names) do draw(self, name, qualities[name]) end
    local shares = morph(self, dt)
    push(self, shares)
    for i, motor in ipairs(self.motors) do move(self, motor, i, shares) end
  end,
}
