-- Ring of lights: a wave runs around a ring of lamps on jointed stems. It bends the stems and lights the lamps.

-- Sizes
local kLamps = 32
local kRadius = 2 -- m, of the ring
local kRod = 0.6 -- m, length of each of the two rods of a stem

-- Shapes that all stems share
local rod = sim:add_capsule_shape("rod", 0.025, kRod - 0.05)
local foot = sim:add_cylinder_shape("foot", 0.1, 0.04)
for _, shape in ipairs { rod, foot } do
  shape.color = vec3(0.6, 0.4, 0.5)
end

-- One lamp, at an angle in the ring
local function add_lamp(name, angle)
  local outward = vec3(math.cos(angle), math.sin(angle), 0)
  local along = vec3(-math.sin(angle), math.cos(angle), 0)
  local function at(height) return outward * kRadius + vec3(0, 0, height) end

  local bulb = sim:add_sphere_shape(name, 0.12)
  local color = vec3(angle / (2 * math.pi), 0.8, 1) -- hue, saturation, brightness
  bulb.color = color

  local body = sim:add_body(name)
  body:add_part("foot", foot, { mass = 0, position = at(0.02) })
  body:add_part("lower", rod, { mass = 0.3, position = at(kRod / 2) })
  body:add_part("upper", rod, { mass = 0.2, position = at(kRod * 1.5) })
  body:add_part("bulb", bulb, { mass = 0.1, position = at(kRod * 2) })
  local ankle = body:add_joint("ankle", "foot", "lower", { position = at(0), axis = along })
  local knee = body:add_joint("knee", "lower", "upper", { position = at(kRod), axis = along })
  body:add_joint("socket", "upper", "bulb", { type = "fixed" })
  return { ankle = body:add_motor(ankle), knee = body:add_motor(knee), bulb = bulb, angle = angle, flash = 0 }
end

-- The ring
local lamps = {}
for i = 1, kLamps do
  lamps[i] = add_lamp("lamp" .. i, 2 * math.pi * (i - 1) / kLamps)
end

-- View
visuals.camera:look_at(vec3(0, -6.5, 2.9), vec3(0, 0, 0.7))

-- Sliders
params {
  { "rate", 0.25, min = 0, max = 2, unit = "Hz", doc = "Waves per second that pass a lamp." },
  { "waves", 2, min = 0, max = 8, doc = "Number of waves around the ring." },
  { "bend", 0.6, min = 0, max = 1.2, unit = "rad", doc = "How far the joints bend." },
  { "glow", 6, min = 0, max = 10, doc = "How bright a lamp is at the top of the wave." },
}

-- The wave
state.phase = state.phase or 0
sim:on_step(function(dt)
  state.phase = state.phase + 2 * math.pi * params.rate * dt
  for _, lamp in ipairs(lamps) do
    local wave = math.sin(state.phase - params.waves * lamp.angle)
    lamp.ankle.target = params.bend * (0.4 - 0.6 * wave)
    lamp.knee.target = -params.bend * (0.4 - wave)
    lamp.flash = lamp.flash * math.exp(-dt / 0.4)
    lamp.bulb.ambient_scale = math.min(0.1 + params.glow * (0.5 + 0.5 * wave) ^ 3 + lamp.flash, 10)
  end
end)

-- A message
osc:on("/flash", function(strength)
  for _, lamp in ipairs(lamps) do lamp.flash = math.clamp(strength or 10, 0, 10) end
end)
