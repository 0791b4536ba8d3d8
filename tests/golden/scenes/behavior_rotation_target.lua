-- The built-in behavior rotation_target: servos and springs that move to a target.
--@ ticks 120
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
for motor in arm:motors() do motor.max_angular_force = 30 end

arm:add_behavior("rotation_target", "reach", { joints = "joint_[1-4]", target = vec3(0, 0, 1.1), speed = 0.05 })
arm:motor("joint_5").mode = "spring"
arm:motor("joint_5").angular_spring_stiffness = 20
arm:add_behavior("rotation_target", "bend", { motors = "joint_5", target = vec3(0, 0, -0.7), speed = 0.2, app_interval = 40 })
