-- turn(motor, target, speed): one application of rotation_target. Sets every servo or spring axis of the motor to an
-- angle between the joint's angle and `target` (rad), by at most `speed` (rad) ahead of the joint.

-- Wraps an angle to (−pi, pi].
local function wrap(angle)
  return angle - 2 * math.pi * math.ceil((angle - math.pi) / (2 * math.pi))
end

-- Returns the new setting of an axis, by the shorter way if it is free; `old` if its mode doesn't match.
local function toward(fits, old, angle, target, speed, free)
  if not fits then return old end
  local way = target - angle
  if free then way = wrap(way) end
  return angle + math.clamp(way, -speed, speed)
end

return function(motor, target, speed)
  local joint = motor.joint
  local angles, lower, upper = joint.angles, joint.angular_lower_limit, joint.angular_upper_limit
  local free_x, free_y, free_z = lower.x > upper.x, lower.y > upper.y, lower.z > upper.z
  local active, servo, spring = motor.angular_active, motor.angular_servo_active, motor.angular_spring_active
  local x, y, z = spring.x, spring.y, spring.z
  if x or y or z then
    local old = motor.angular_spring_rest_length
    motor.angular_spring_rest_length = vec3(
      toward(x, old.x, angles.x, target.x, speed, free_x),
      toward(y, old.y, angles.y, target.y, speed, free_y),
      toward(z, old.z, angles.z, target.z, speed, free_z))
  end
  -- an axis in spring mode isn't a servo
  x, y, z = active.x and servo.x and not x, active.y and servo.y and not y, active.z and servo.z and not z
  if x or y or z then
    local old = motor.angular_servo_position
    motor.angular_servo_position = vec3(
      toward(x, old.x, angles.x, target.x, speed, free_x),
      toward(y, old.y, angles.y, target.y, speed, free_y),
      toward(z, old.z, angles.z, target.z, speed, free_z))
  end
end
