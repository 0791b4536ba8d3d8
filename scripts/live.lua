-- LIVE: a scene to be changed while it plays. Start it, keep this file open beside it, change a line, save, and look:
--
--     ./run scripts/live.lua
--
-- What you change is applied at once; all the rest goes on as it was. A mistake changes nothing: the last good version
-- plays on, and the error says file, line and cure. Try the steps below in any order.

-- STEP 1. The world. Make gravity a moon's: (0, 0, -1.6). Bodies keep their place and speed, they only fall softer.
sim.gravity = vec3(0, 0, -9.81)

local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"), { friction = 0.8 })

-- STEP 2. Sliders. They are in the panel, and over OSC: /scene/bounce 2. What a hand has moved stays moved when you
-- save, unless you change the very line that says the default.
params {
  { "bounce", 1, min = 0, max = 4, unit = "m/s", doc = "How hard the balls are thrown up at each beat." },
  { "beat", 2, min = 0.25, max = 8, unit = "s", doc = "Time between two beats." },
}

-- STEP 3. A ring of balls. Change kBalls to 5, or to 20: new ones appear, the others move to their new places. Change
-- the radius 0.1: they are made anew where they are.
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

-- STEP 4. An arm in the middle, breathing. Change rate, depth or lag; or open behaviors_lua/breathe.lua and change what
-- breathing is. Take "breathe" away and put "wave" there.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("breathe", "breath", { rate = 0.2, depth = 0.5, lag = 0.8 })

-- STEP 5. A wind at its tip, of a built-in behaviour. Give it strength: max_amp = 5.
arm:add_behavior("random_force", "wind", { parts = -1, max_amp = 0, rand_interval = 1500 })

-- STEP 6. What happens at each beat. Callbacks are hands: they act, and a new version simply takes over. `state` is
-- kept when you save: the beats go on counting.
state.beats = state.beats or 0
state.next = state.next or 0
sim:on_step(function()
  if sim.time < state.next then return end
  state.next = sim.time + params.beat
  state.beats = state.beats + 1
  local body = sim:body("ball" .. (state.beats - 1) % kBalls + 1)
  body.root:apply_impulse(vec3(0, 0, params.bounce * body.root.mass))
end)

-- STEP 7. Play it from outside: oscsend 127.0.0.1 9003 /kick f 3
osc:on("/kick", function(strength)
  for i = 1, kBalls do
    local root = sim:body("ball" .. i).root
    root:apply_impulse(vec3(0, 0, (strength or 2) * root.mass))
  end
end)

-- STEP 8. Now break it: write "arm:add_behaviour(" somewhere and save. Nothing stops. Read the message, mend it.
