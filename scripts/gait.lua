-- A gait that a search has found: the quadruped walks three times as fast as that of quadruped.lua.
-- Each joint follows a wave; the default values of the parameters are the result of this search:
--
--   limber evolve scripts/gait.lua --maximize speed --seeds 1:2 --duration 30 --population 16 --generations 40
--
-- Try while it runs:   oscsend 127.0.0.1 9003 /scene/pace f 1.5

sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })

-- it looks a little to one side, another one for each seed, so that only a gait that turns back is good
local dog = sim:load_urdf("urdf/quadruped.urdf", {
  name = "dog", position = vec3(0, 0, 0.40), rotation = quat.axis(vec3(0, 0, 1), math.rad(math.random(-20, 20))),
})
for part in dog:parts() do part.friction = 0.9 end
local trunk = dog:part("trunk")

params {
  { "pace",  2.978,   min = 1,    max = 3,   unit = "Hz", doc = "Steps of each leg per second." },
  { "swing", 0.3082,  min = 0,    max = 0.8, unit = "rad", doc = "How far the thighs swing to either side." },
  { "lift",  0.1644,  min = 0,    max = 1.2, unit = "rad", doc = "How far the knees bend in the air." },
  { "lag",   -0.431,  min = -0.5, max = 0.5, doc = "Lag of the knees behind the thighs, in steps." },
  { "pair",  0.03566, min = 0,    max = 1,   doc = "Lag of the right legs behind the left ones, in steps." },
  { "back",  0.2333,  min = 0,    max = 1,   doc = "Lag of the back legs behind the front ones, in steps." },
  { "lean",  0.01612, min = -0.5, max = 0.5, unit = "rad", doc = "Mean angle of the thighs." },
  { "bend",  0.5147,  min = -0.6, max = 0.6, unit = "rad", doc = "Mean angle of the knees." },
  { "push",  1.167,   min = 0.3,  max = 1.7, doc = "Swing of the back thighs, as a factor of that of the front ones." },
  { "slope", -0.3623, min = -0.4, max = 0.4, unit = "rad", doc = "Mean angle of the back thighs, relative to the front ones." },
  { "width", 0.1411,  min = -0.2, max = 0.2, unit = "rad", doc = "How far the hips spread the legs." },
  { "steer", 0.9062,  min = 0,    max = 3,   doc = "How much more the legs of one side swing for each rad to turn back." },
}

local legs = {}
for i, name in ipairs { "front_left", "front_right", "back_left", "back_right" } do
  legs[i] = {
    hip = dog:motor(name .. "_hip"), thigh = dog:motor(name .. "_thigh"), knee = dog:motor(name .. "_knee"),
    right = i % 2 == 0, back = i > 2,
  }
end

local START = 1  -- it stands until this time, s
state.phase = state.phase or 0
state.fallen = state.fallen or false

sim:on_step(function(dt)
  if not state.fallen then
    state.distance = trunk.position.x - math.abs(trunk.position.y)
    state.fallen = trunk.position.z < 0.18 or (trunk.rotation * vec3(0, 0, 1)).z < 0.5
  end
  if sim.time < START then return end
  local ease = math.min(1, sim.time - START)  -- sudden movements would topple it
  local ahead = trunk.rotation * vec3(1, 0, 0)
  local steer = math.clamp(params.steer * math.atan2(ahead.y, ahead.x), -0.5, 0.5)
  state.phase = (state.phase + params.pace * dt) % 1
  for _, leg in ipairs(legs) do
    local phase = state.phase + (leg.right and params.pair or 0) + (leg.back and params.back or 0)
    local swing = params.swing * (leg.back and params.push or 1) * (1 + (leg.right and -steer or steer))
    local lean = params.lean + (leg.back and params.slope or 0)
    leg.hip.target = ease * params.width
    leg.thigh.target = ease * (lean + swing * math.sin(2 * math.pi * phase))
    leg.knee.target = ease * (params.bend + params.lift * math.max(0, math.cos(2 * math.pi * (phase - params.lag))))
  end
end)

-- Mean speed straight ahead from the first step to the end, or to the fall, in m/s.
result("speed", function() return state.distance / math.max(sim.time - START, 1) end)

visuals.camera.distance = 4
sim:on_start(function() visuals.camera:follow(dog) end)
