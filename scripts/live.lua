-- LIVE: a scene to edit while it plays. Start it, keep this file open, change a line, save, and watch:
--
--     ./run scripts/live.lua
--
-- Your changes are applied at once; everything else continues. A mistake changes nothing: the last good version keeps
-- playing, and the message shows file, line and fix. Try the steps below in any order.

-- STEP 1. The world. Set the moon's gravity: (0, 0, -1.6). Bodies keep their positions and velocities; they just fall
-- slower.
sim.gravity = vec3(0, 0, -9.81)

local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"), { friction = 0.8 })

-- STEP 2. Sliders. They are in the panel, and available over OSC: /scene/bounce 2. A slider that was moved keeps its
-- value when you save, unless you edit its default.
params {
  { "bounce", 1, min = 0, max = 4, unit = "m/s", doc = "How hard the balls are thrown up at each beat." },
  { "beat", 2, min = 0.25, max = 8, unit = "s", doc = "Time between two beats." },
}

-- STEP 3. A ring of balls. Change kBalls to 5, or to 20: new ones appear, the others move to their new positions.
-- Change the radius 0.1: they are rebuilt where they are.
local kBalls = 8
local kRing = 1.5 -- m
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, kBalls do
  local angle = 2 * math.pi * i / kBalls
  local body = sim:add_body("ball" .. i)
  body:add_part("ball", ball, {
    mass = 0.3,
    restitution = 0.6,
    position = vec3(kRing * math.cos(angle), kRing * math.sin(angle), 0.5),
  })
end

-- STEP 4. A breathing arm in the middle. Change rate, depth or lag; or edit the motion itself in
-- behaviors_lua/breathe.lua. Replace "breathe" by "wave".
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("breathe", "breath", { rate = 0.2, depth = 0.5, lag = 0.8 })

-- STEP 5. Wind at its tip, with a built-in behavior. Give it some strength: max_amp = 5.
arm:add_behavior("random_force", "wind", { parts = "tip", max_amp = 0, rand_interval = 1500 })

-- STEP 6. The action at each beat. Callbacks are replaced by the new version when you save. `state` keeps its contents:
-- the beats continue to count.
state.beats = state.beats or 0
state.next = state.next or 0
sim:on_step(function()
  if sim.time < state.next then return end
  state.next = sim.time + params.beat
  state.beats = state.beats + 1
  local body = sim:body("ball" .. (state.beats - 1) % kBalls + 1)
  body.root:apply_impulse(vec3(0, 0, params.bounce * body.root.mass))
end)

-- STEP 7. Control it from outside: oscsend 127.0.0.1 9003 /kick f 3
osc:on("/kick", function(strength)
  for i = 1, kBalls do
    local root = sim:body("ball" .. i).root
    root:apply_impulse(vec3(0, 0, (strength or 2) * root.mass))
  end
end)

-- STEP 8. Now break it: write "arm:add_behaviour(" somewhere and save. Nothing stops. Read the message and fix the
-- line.
