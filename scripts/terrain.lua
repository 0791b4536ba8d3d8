-- A quadruped walks over hills. Each foot feels the ground: it lights up with its load, and leaves a mark where it lands.
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/stride f 0.05
--                      oscsend 127.0.0.1 9003 /scene/turn f 0.4
--                      oscsend 127.0.0.1 9003 /push f 4
-- Listen:              oscdump 9005     /foot NAME FORCE 20 times per second, /step NAME FORCE X Y Z for each landing

-- Long waves and short bumps, level where it starts
local function height(x, y)
  local waves = 0.22 * math.sin(0.55 * x) * math.cos(0.45 * y) + 0.1 * math.sin(0.9 * y + 0.35 * x)
  local bumps = 0.012 * math.sin(4.1 * x + 1) * math.sin(3.7 * y)
  local away = math.clamp((math.sqrt(x * x + y * y) - 0.4) / 1.5, 0, 1)
  return 0.5 * (waves + bumps) * away * away * (3 - 2 * away)
end

local hills = sim:add_heightfield_shape("hills", { size = { 40, 40 }, rows = 401, columns = 401, heights = height })
hills.color = rgb(0.1, 0.15, 0.08)
hills.specular_scale = 0.1
sim:add_body("hills"):add_part("hills", hills, { friction = 1.2 })

local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 0.40) })
for part in dog:parts() do part.friction = 1 end

params {
  { "stride", 0.1, min = 0,  max = 0.16, unit = "m",  doc = "How far a foot travels on the ground; 0 trots on the spot." },
  { "pace",   3,  min = 0.5, max = 4,  unit = "Hz", doc = "Steps of each leg per second." },
  { "turn",   0.15,  min = -1, max = 1,  unit = "rad/s", doc = "How fast it turns (positive: left)." },
  { "lift",   0.05, min = 0,  max = 0.12, unit = "m",  doc = "How high a foot is raised." },
  { "height", 0.30, min = 0.26, max = 0.38, unit = "m", doc = "Hips above the feet." },
}

local LEG, BEND, ON_GROUND = 0.22, 0.6, 0.6  -- as in quadruped.lua
local COMPLIANCE = 0.3  -- fraction of a tilt that the feet on the ground follow
local LEAN = 0.8        -- share of a tilt by which the feet move along with it
local legs = {
  { name = "front_left",  x = 0.18,  y = 0.14,  phase = 0,   hue = 0.55 },
  { name = "back_right",  x = -0.18, y = -0.14, phase = 0,   hue = 0.02 },
  { name = "front_right", x = 0.18,  y = -0.14, phase = 0.5, hue = 0.12 },
  { name = "back_left",   x = -0.18, y = 0.14,  phase = 0.5, hue = 0.85 },
}
local trunk = dog:part("trunk")
local MARKS = 14  -- footprints of each foot
for _, leg in ipairs(legs) do
  leg.hip, leg.thigh, leg.knee = dog:motor(leg.name .. "_hip"), dog:motor(leg.name .. "_thigh"), dog:motor(leg.name .. "_knee")
  leg.shin = dog:part(leg.name .. "_shin")  -- its foot is fixed to it
  leg.shin.report_contacts = true
  leg.color = visuals:shape("quadruped." .. leg.name .. "_shin.2")  -- its foot
  leg.force, leg.mark = 0, 0
  local print_shape = sim:add_cylinder_shape(leg.name .. "_print", 0.03, 0.006)
  print_shape.color = vec3(leg.hue, 0.85, 1)
  leg.marks = sim:add_body(leg.name .. "_prints")
  for i = 1, MARKS do
    leg.marks:add_part("print" .. i, print_shape, { mass = 0, position = vec3(0, 0, -20), collision_mask = 0, collision_group = 0 })
  end
end

local function reach(leg, x, y, z)
  local down = math.sqrt(y * y + z * z)
  local half = math.acos(math.clamp(math.sqrt(x * x + down * down) / (2 * LEG), 0, 1))
  local mean = math.atan2(-x, down)
  leg.hip.target = math.atan2(leg.y > 0 and y or -y, -z)
  leg.thigh.target = BEND - (mean + half)
  leg.knee.target = 2 * half - 2 * BEND
end

-- Returns the position of a foot in its step, from 0.5 to -0.5, and its height, 0 .. 1.
local function step_of(phase)
  if phase < ON_GROUND then return 0.5 - phase / ON_GROUND, 0 end
  local air = (phase - ON_GROUND) / (1 - ON_GROUND)
  return -0.5 + air - math.sin(2 * math.pi * air) / (2 * math.pi), math.sin(math.pi * air)
end

state.phase = state.phase or 0
state.eager = state.eager or 0    -- 0 stands .. 1 lifts its feet
state.stride = state.stride or 0
state.turn = state.turn or 0

local function towards(now, target, max_change) return now + math.clamp(target - now, -max_change, max_change) end

-- How fast to turn: as the slider says, but back to the middle where the hills end
local function wanted_turn()
  local p, ahead = dog.position, trunk.rotation * vec3(1, 0, 0)
  if p.x * p.x + p.y * p.y < 100 then return params.turn end
  return ahead.y * p.x > ahead.x * p.y and 0.3 or -0.3
end

sim:on_step(function(dt)
  if sim.time > 1 then
    state.eager = towards(state.eager, 1, dt)
    state.stride = towards(state.stride, params.stride, 0.1 * dt)
    state.turn = towards(state.turn, wanted_turn(), dt)
  end
  state.phase = (state.phase + params.pace * dt) % 1
  local angle = state.turn * ON_GROUND / params.pace
  local ahead, left = trunk.rotation * vec3(1, 0, 0), trunk.rotation * vec3(0, 1, 0)
  for _, leg in ipairs(legs) do
    local way, up = step_of((state.phase + leg.phase) % 1)
    local sin, cos = math.sin(angle * way), math.cos(angle * way)
    local x = state.stride * way + leg.x * (cos - 1) - leg.y * sin
    local y = leg.x * sin + leg.y * (cos - 1)
    local tilt = up > 0 and 0 or COMPLIANCE * (leg.x * ahead.z + leg.y * left.z)
    x, y = x + LEAN * params.height * ahead.z, y + LEAN * params.height * left.z
    reach(leg, x, y, state.eager * (params.lift * up - tilt) - params.height)
  end
end)

-- A foot that lands leaves a mark along the slope below it, and reports its force and place.
local function land(leg, point)
  leg.mark = leg.mark % MARKS + 1
  local mark = leg.marks:part("print" .. leg.mark)
  local slope = vec3(point.normal.x, point.normal.y, math.abs(point.normal.z))
  mark.position = point.position
  mark.rotation = quat.euler(math.atan2(-slope.y, slope.z), math.atan2(slope.x, slope.z), 0)
  osc:send("/step", leg.name, leg.force, point.position.x, point.position.y, point.position.z)
end

sim:on_step(function()
  for _, leg in ipairs(legs) do
    local before, force = leg.force, leg.shin.contact_normal_force
    leg.force = force
    local load = math.clamp(force / 60, 0, 1)  -- its share of the weight is about 20 N
    leg.color.color = vec3(leg.hue, 0.85, 0.15 + 0.85 * math.sqrt(load))
    if before == 0 and force > 0 and sim.time > 0.5 then
      local points = leg.shin:contacts()
      if #points > 0 then land(leg, points[1]) end
    end
  end
end)
sim:every(0.05, function()
  for _, leg in ipairs(legs) do osc:send("/foot", leg.name, leg.force) end
end)

-- After a fall it is put on its feet again where it lies.
sim:every(2, function()
  if (trunk.rotation * vec3(0, 0, 1)).z > 0.5 then return end
  local p = dog.position
  dog.rotation = quat()
  dog.position = vec3(p.x, p.y, height(p.x, p.y) + 0.4)
  for part in dog:parts() do part.linear_velocity, part.angular_velocity = vec3(), vec3() end
  state.eager, state.stride = 0, 0
end)

osc:on("/push", function(strength) trunk:apply_impulse(vec3(0, strength or 4, 0)) end)

visuals.look.floor = false
visuals.camera.distance = 2.4
sim:on_start(function() visuals.camera:follow(dog) end)
