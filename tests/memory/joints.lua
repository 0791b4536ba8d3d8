-- Each joint type: free, limited, driven, in loops and in contact, far apart: all at once, or only the one with number
-- `case`. Prints the state hash of a body in each tick. For valgrind and for comparing processes.
params { { "case", 0, min = 0, max = 100, step = 1, rerun = true }, { "iterative", 0, min = 0, max = 1, rerun = true } }
local types = { "revolute", "continuous", "prismatic", "planar", "floating", "spherical", "fixed" }
local uses = { "free", "limited", "off", "spin", "servo", "spring", "loop", "driven loop", "floating base", "contact" }

local box = sim:add_box_shape("box", vec3(0.2, 0.2, 0.2))
local rod = sim:add_capsule_shape("rod", 0.05, 0.2)
local ball = sim:add_sphere_shape("ball", 0.08)

-- calls f for the linear and angular half of a joint, with its free axes (lower limit above the upper one)
local function free_axes(joint, f)
  for _, half in ipairs { "linear", "angular" } do
    local lower, upper = joint[half .. "_lower_limit"], joint[half .. "_upper_limit"]
    f(half, lower, upper, { lower.x > upper.x, lower.y > upper.y, lower.z > upper.z })
  end
end

local function limit(joint, range)
  free_axes(joint, function(half, lower, upper, free)
    local function chosen(value, other)
      return vec3(free[1] and value or other.x, free[2] and value * 0.8 or other.y, free[3] and value * 0.6 or other.z)
    end
    joint[half .. "_lower_limit"], joint[half .. "_upper_limit"] = chosen(-range, lower), chosen(range, upper)
  end)
end

local function drive(body, kind, joint, mode)
  if kind == "fixed" then return end
  local motor = joint.motor or body:add_motor(joint)
  motor.damping = 0.02
  free_axes(joint, function(half, _, _, free)
    motor[half .. "_active"] = (mode == "spin" or mode == "servo") and free or false
    motor[half .. "_servo_active"] = mode == "servo" and free or false
    motor[half .. "_spring_active"] = mode == "spring" and free or false
    motor[half .. "_velocity"] = vec3(0.7, -0.5, 0.3)
    motor["max_" .. half .. "_force"] = vec3(20, 15, 10)
    motor[half .. "_servo_position"] = vec3(0.2, -0.1, 0.3)
    motor[half .. "_spring_rest_length"] = vec3(0.1, -0.2, 0.1)
    motor[half .. "_spring_stiffness"] = vec3(30, 20, 10)
    motor[half .. "_spring_damping"] = vec3(0.5, 0.4, 0.3)
  end)
end

local function joint_of(body, name, parent, child, kind, place, axis)
  -- a revolute joint without limits is a continuous one
  local joint = body:add_joint(name, parent, child,
    { type = kind == "continuous" and "revolute" or kind, position = place, axis = axis })
  if kind == "revolute" then limit(joint, 2) end
  return joint
end

-- base, arm and tip in a chain, with two joints of that type
local function chain(name, kind, use, p)
  local body = sim:add_body(name)
  local stands = use ~= "contact" and use ~= "floating base"
  local base = body:add_part("base", box, { position = p, mass = stands and 0 or 2 })
  local arm = body:add_part("arm", rod, { position = p + vec3(0.3, 0, 0), rotation = quat.euler(0, 1.2, 0.2), mass = 1 })
  local tip = body:add_part("tip", ball, { position = p + vec3(0.55, 0.02, 0.03), mass = 0.5 })
  local first = joint_of(body, "first", base, arm, kind, p + vec3(0.15, 0, 0), vec3(0, 1, 0))
  local second = joint_of(body, "second", arm, tip, kind, p + vec3(0.45, 0, 0), vec3(1, 0, 0.3))
  for _, joint in ipairs { first, second } do
    if use == "limited" then limit(joint, 0.05) end
    if use == "off" or use == "spin" or use == "servo" or use == "spring" then drive(body, kind, joint, use) end
    if use == "contact" or use == "floating base" then drive(body, kind, joint, "servo") end
  end
end

-- a loop of four parts; the joints of its upper part are of that type, and the last one closes the loop
local function loop(name, kind, use, p)
  local body = sim:add_body(name)
  local base = body:add_part("base", box, { position = p, mass = 0 })
  local left = body:add_part("left", rod, { position = p + vec3(-0.3, 0, -0.3), mass = 1 })
  local right = body:add_part("right", rod, { position = p + vec3(0.3, 0, -0.3), mass = 1 })
  local top = body:add_part("top", box, { position = p + vec3(0, 0, -0.6), mass = 1 })
  local crank = joint_of(body, "crank", base, left, "continuous", p + vec3(-0.3, 0, -0.1), vec3(0, 1, 0))
  joint_of(body, "rocker", base, right, "continuous", p + vec3(0.3, 0, -0.1), vec3(0, 1, 0))
  local joints = {
    joint_of(body, "left top", left, top, kind, p + vec3(-0.3, 0, -0.5), vec3(0, 1, 0)),
    joint_of(body, "right top", right, top, kind, p + vec3(0.3, 0, -0.5), vec3(0, 1, 0)),
  }
  if use == "driven loop" then
    drive(body, "continuous", crank, "spin")
    for _, joint in ipairs(joints) do drive(body, kind, joint, "servo") end
  end
end

sim.solver = params.iterative > 0.5 and "iterative" or "direct"
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local names, number, only = {}, 0, math.floor(params.case + 0.5)
for i, kind in ipairs(types) do
  for j, use in ipairs(uses) do
    number = number + 1
    if only == 0 or only == number then
      local name = (kind .. "_" .. use):gsub(" ", "_")
      local place = vec3(3 * i, 3 * j, use == "contact" and 0.11 or use == "floating base" and 4 or 3)
      local make = use:find("loop") and loop or chain
      make(name, kind, use, place)
      names[#names + 1] = name
    end
  end
end
sim:on_step(function()
  local name = names[sim.tick % #names + 1]
  print(sim.tick, name, sim:body(name):state_hash())
end)
