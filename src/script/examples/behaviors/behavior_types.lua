-- Several built-in behaviors on one arm. The order of attachment is the order in which they run.
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm" })
arm:add_behavior("random_rotation_target", "wander", { motors = "joint_[2-4]", rand_interval = 800 })
arm:add_behavior("random_force", "gusts", { parts = "tip", max_amp = 2 })
arm:add_behavior("speed", "limit", { speed = 3 })
print(#arm.behaviors, arm.behaviors[2].type, arm.behaviors[2].place) --> 3 random_force 2
