-- turn(motor, target, speed): one application of rotation_target. Every axis of the motor that is in servo or spring
-- mode is sent from where its joint stands towards `target` (rad), by `speed` (rad) at most.

-- an angle in (−pi, pi]
local function wrap(angle)
  return angle - 2 * math.pi * math.ceil((angle - math.pi) / (2 * math.pi))
end

local function toward(angle, target, speed, free)
  local way = target - angle
  if free then way = wrap(way) end
  return angle + math.clamp(way, -speed, speed)
end

-- three numbers: what drives where its mode fits, else what stood there before
local function pick(fits, new, old)
  return vec3(fits[1] and new.x or old.x, fits[2] and new.y or old.y, fits[3] and new.z or old.z)
end

return function(motor, target, speed)
  local joint = motor.joint
  local angles, lower, upper = joint.angles, joint.angular_lower_limit, joint.angular_upper_limit
  local new = vec3(
    toward(angles.x, target.x, speed, lower.x > upper.x),
    toward(angles.y, target.y, speed, lower.y > upper.y),
    toward(angles.z, target.z, speed, lower.z > upper.z))
  local active, servo, spring = motor.angular_active, motor.angular_servo_active, motor.angular_spring_active
  local servos, springs = {}, {}
  for axis = 1, 3 do
    springs[axis] = spring[axis]
    servos[axis] = active[axis] and servo[axis] and not spring[axis]
  end
  if servos[1] or servos[2] or servos[3] then
    motor.angular_servo_position = pick(servos, new, motor.angular_servo_position)
  end
  if springs[1] or springs[2] or springs[3] then
    motor.angular_spring_rest_length = pick(springs, new, motor.angular_spring_rest_length)
  end
end
