-- A robot stands (or hangs from a fixed base) for 10 s, then follows random targets for 10 s. .ci/robot_steps.sh
-- prepends lines that set `robot_file` and `free_base`. Prints one line that begins with "robot ".
local hold, finish = 10, 20 -- s
local drop = 0.3 -- m, from the lowest part's center to the floor

local robot = sim:load_urdf(robot_file, { name = "robot", fixed_base = not free_base })
local joints, parts, motors = {}, {}, {}
for joint in robot:joints() do joints[#joints + 1] = joint end
for part in robot:parts() do parts[#parts + 1] = part end
for motor in robot:motors() do motors[#motors + 1] = motor end

local low, high = math.huge, -math.huge
for _, part in ipairs(parts) do
  low, high = math.min(low, part.position.z), math.max(high, part.position.z)
end
local fall = drop + (high - low)
if free_base then
  sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { position = vec3(0, 0, low - drop) })
else
  fall = 2 * fall
end

-- Returns how much faster a part is than in a free fall from the start, m/s. Parts without collision geometry fall
-- through the floor.
local function excess(part)
  local dropped = math.max(fall, high - part.position.z)
  return part.linear_velocity:length() - math.sqrt(2 * 9.81 * dropped)
end

-- Returns the position error of a joint in its locked directions, m.
local function gap(joint)
  local o = joint.offsets
  if joint.type == "planar" or joint.type == "floating" then return 0 end
  if joint.type == "prismatic" then return math.sqrt(o.x * o.x + o.y * o.y) end
  return o:length()
end

-- sets a random target within the limits
local function randomize_target(motor)
  local joint = motor.joint
  if joint.type ~= "revolute" and joint.type ~= "prismatic" then return end
  local along = joint.type == "prismatic" and "linear" or "angular"
  local lower, upper = joint[along .. "_lower_limit"].z, joint[along .. "_upper_limit"].z
  if lower >= upper then return end
  motor.speed = motor.speed > 0 and math.min(motor.speed, 3) or 3
  motor.target = lower + (upper - lower) * math.random()
end

local max_excess, widest = 0, 0
sim:on_step(function()
  if sim.time >= hold and sim.tick % 30 == 0 then
    for _, motor in ipairs(motors) do randomize_target(motor) end
  end
  for _, part in ipairs(parts) do max_excess = math.max(max_excess, excess(part)) end
  for _, joint in ipairs(joints) do widest = math.max(widest, gap(joint)) end
end)

sim:at(finish, function()
  local faults = {}
  if not (max_excess <= 20) then faults[#faults + 1] = string.format("%.0f m/s above free fall", max_excess) end
  if not (widest <= 0.002) then faults[#faults + 1] = string.format("a joint gap of %.1f mm", widest * 1e3) end
  if sim.solver_fallbacks > 0 then faults[#faults + 1] = sim.solver_fallbacks .. " fallbacks" end
  if not robot.enabled then faults[#faults + 1] = "disabled" end
  print("robot " .. (#faults == 0 and "fine" or table.concat(faults, ", ")))
end)
