---@meta

-- What Limber's scripts see, for editors that read LuaCATS (lua-language-server). `limber annotate` writes this file from
-- src/script/annotations and the tables of the program: change those, not this.
-- Metres, kilograms, seconds, newtons, radians; Z up; world frame unless a line says otherwise.

---@alias vec3like vec3|number[]

---Three numbers. A copy that never changes: set the whole value.
---@class vec3
---@field x number
---@field y number
---@field z number
---@operator add(vec3like): vec3
---@operator sub(vec3like): vec3
---@operator mul(vec3like|number): vec3
---@operator div(vec3like|number): vec3
---@operator unm: vec3
local vec3_ = {}

---Its length.
---@return number
function vec3_:length() end

---Of length 1; the zero vector stays zero.
---@return vec3
function vec3_:normalized() end

---The scalar product.
---@param other vec3like
---@return number
function vec3_:dot(other) end

---The vector product.
---@param other vec3like
---@return vec3
function vec3_:cross(other) end

---Straight from this one (t = 0) to the other (t = 1).
---@param other vec3like
---@param t number
---@return vec3
function vec3_:lerp(other, t) end

---A vector; what is left out is 0.
---@param x? number|number[]
---@param y? number
---@param z? number
---@return vec3
function vec3(x, y, z) end

---A rotation. `p * q` turns by q first; `q * v` turns a vector.
---@class quat
---@field x number
---@field y number
---@field z number
---@field w number
---@operator mul(quat): quat
---@operator mul(vec3like): vec3
local quat_ = {}

---The rotation back.
---@return quat
function quat_:inverse() end

---The shortest way from this one (t = 0) to the other (t = 1).
---@param other quat
---@param t number
---@return quat
function quat_:slerp(other, t) end

---Makes rotations: `quat(x, y, z, w)`, without numbers the identity.
---@class quat_maker
---@overload fun(): quat
---@overload fun(x: number, y: number, z: number, w: number): quat
quat = {}

---About the fixed axes x, then y, then z.
---@param x? number # rad
---@param y? number # rad
---@param z? number # rad
---@return quat
function quat.euler(x, y, z) end

---A turn about a direction.
---@param direction vec3like # Need not be of length 1.
---@param angle number # rad
---@return quat
function quat.axis(direction, angle) end

---Three booleans, one an axis: members 1, 2, 3 or x, y, z.
---@class flags3
---@field x boolean
---@field y boolean
---@field z boolean
---@field [integer] boolean

---A colour as hue, saturation, brightness (each 0 .. 1) from red, green, blue (each 0 .. 1).
---@param r number
---@param g number
---@param b number
---@return vec3
function rgb(r, g, b) end

---x, but at least lo and at most hi.
---@param x number
---@param lo number
---@param hi number
---@return number
function math.clamp(x, lo, hi) end

---a at t = 0, b at t = 1, straight between them.
---@param a number
---@param b number
---@param t number
---@return number
function math.lerp(a, b, t) end

---x of a .. b as the same place in c .. d.
---@param x number
---@param a number
---@param b number
---@param c number
---@param d number
---@return number
function math.map(x, a, b, c, d) end

---Smooth noise, -1 .. 1, always the same.
---@param x number
---@param y? number
---@param z? number
---@return number
function math.noise(x, y, z) end

---The file's own generator; it starts from the seed in each run. `math.random` draws from it too.
---@class rng
rng = {}

---A number 0 .. 1, or a .. b; with vec3s one for each axis.
---@overload fun(self: rng, a: vec3like, b: vec3like|number): vec3
---@param a? number
---@param b? number
---@return number
function rng:uniform(a, b) end

---A direction: a vector of length 1, every way as likely.
---@return vec3
function rng:direction() end

---Normally distributed: mean 0, deviation 1.
---@return number
function rng:normal() end

---Text as it is, to stderr and the console, as a warning.
---@param ... any
function warn(...) end

-- Bodies and what they are made of. Things can be compared and be keys of tables.

---Parts, joints and motors under one name.
---@class body
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists; any other use of a gone thing is an error.
---@field root part # read-only. The first part.
---@field parts part_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field joints joint_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field motors motor_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field behaviors behavior_list # read-only. In the order in which they were attached.
---@field excluded_pairs part[][] # read-only. Pairs of parts that are excluded from collision: `{ { a, b }, … }`.
---@field position vec3like # m, -10000 .. 10000. The root's link frame, world; setting it moves the whole body rigidly. The stability check restores it from 10 km on.
---@field rotation quat # The root's link frame, world: x y z w; setting it turns the whole body about the root.
---@field linear_velocity vec3like # m/s, -10000 .. 10000. The root's; setting it gives the whole body this motion. The stability check restores it from 500 m/s on.
---@field angular_velocity vec3like # rad/s, -10000 .. 10000. The root's; setting it turns the whole body about the root. The stability check restores what tumbles at 1000 rad/s.
---@field self_collision boolean # default true. Whether its parts collide with each other; two that a joint connects never do, nor pairs of excluded_pairs.
---@field can_sleep boolean # default true. Whether its parts fall asleep when they are at rest; asleep, they cost nothing until something acts on them.
---@field asleep boolean # read-only. All its parts that can move are asleep.
---@field enabled boolean # False: out of the world, as health leaves a body that broke twice; reset enables.
local body_ = {}

---@class body_opts
---@field position? vec3like # m, -10000 .. 10000. The root's link frame, world; setting it moves the whole body rigidly. The stability check restores it from 10 km on.
---@field rotation? quat # The root's link frame, world: x y z w; setting it turns the whole body about the root.
---@field linear_velocity? vec3like # m/s, -10000 .. 10000. The root's; setting it gives the whole body this motion. The stability check restores it from 500 m/s on.
---@field angular_velocity? vec3like # rad/s, -10000 .. 10000. The root's; setting it turns the whole body about the root. The stability check restores what tumbles at 1000 rad/s.
---@field self_collision? boolean # default true. Whether its parts collide with each other; two that a joint connects never do, nor pairs of excluded_pairs.
---@field can_sleep? boolean # default true. Whether its parts fall asleep when they are at rest; asleep, they cost nothing until something acts on them.
---@field enabled? boolean # False: out of the world, as health leaves a body that broke twice; reset enables.

---A part of that shape. Its pose is in the world, left out: the origin.
---@param name string
---@param shape shape|string
---@param opts? part_opts # `mass` 0: it never moves.
---@return part
function body_:add_part(name, shape, opts) end

---A joint between two parts. The pose it is made in is its zero; its own motion is free until it gets limits.
---@param name string
---@param parent part|string|integer
---@param child part|string|integer
---@param opts? joint_opts
---@return joint
function body_:add_joint(name, parent, child, opts) end

---The motor of a joint, with the joint's name; made as a servo that holds.
---@param joint joint|string|integer
---@param opts? motor_opts
---@return motor
function body_:add_motor(joint, opts) end

---A part by its name or number (-1: the last). An error with the near names when there is none.
---@param key string|integer|part
---@return part
function body_:part(key) end

---A joint by its name or number (-1: the last).
---@param key string|integer|joint
---@return joint
function body_:joint(key) end

---Attaches a behaviour: a built-in type, or a file of behaviors_lua/.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string
---@param opts? behavior_opts # Whom it acts on (left out: all), `active`, and the type's parameters.
---@return behavior
function body_:add_behavior(type, name, opts) end

---A behaviour by its name or number (-1: the last).
---@param key string|integer|behavior
---@return behavior
function body_:behavior(key) end

---A motor by its name or number (-1: the last).
---@param key string|integer|motor
---@return motor
function body_:motor(key) end

---A link of the URDF file, a merged one too.
---@param name string
---@return link
function body_:link(name) end

---A copy of all that is said about the body up to here.
---@param name string
---@param opts? body_opts
---@return body
function body_:copy(name, opts) end

---Excludes two parts of the body from collision with each other.
---@param a part|string|integer
---@param b part|string|integer
function body_:exclude_pair(a, b) end

---Lets two parts collide that exclude_pair, or an overlap at the home pose, excluded.
---@param a part|string|integer
---@param b part|string|integer
function body_:include_pair(a, b) end

---Back to the start pose, at rest.
function body_:reset() end

---Takes the body away.
function body_:remove() end

---Text that is the same when the body is the same to the bit.
---@return string
function body_:state_hash() end

---A rigid piece of a body.
---@class part
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists.
---@field body body # read-only.
---@field shape shape # read-only.
---@field mass number # kg, 0.001 .. 1000000, default 1. Mass; the inertia scales with it. A part made with mass 0 never moves.
---@field linear_damping number # 1/s, 0 .. 1, default 0. Fraction of the velocity lost per second.
---@field angular_damping number # 1/s, 0 .. 1, default 0. Fraction of the angular velocity lost per second.
---@field friction number # 0 .. 100, default 0.5. Coulomb friction; the values of two touching parts multiply.
---@field rolling_friction number # m, 0 .. 100, default 0. Resistance to rolling; the values of two touching parts are mixed.
---@field spinning_friction number # m, 0 .. 100, default 0. Resistance to spinning about the contact's normal; mixed like rolling friction.
---@field friction_direction vec3like # -1 .. 1, default 0 0 0. Direction, link frame, in which friction is scaled by friction_factor; zeros: in none.
---@field friction_factor number # 0 .. 100, default 1. Friction along friction_direction as a multiple of that across it.
---@field restitution number # 0 .. 1, default 0. What a bounce gives back; the values of two touching parts multiply.
---@field self_collision boolean # default true. Whether it collides with other parts of its body.
---@field collision_group integer # 0 .. 65535, default 1. The groups it is in, a bit each (16). Two parts collide if each one's group has a bit in the other's mask.
---@field collision_mask integer # 0 .. 65535, default 65535. The groups it collides with, a bit each (16).
---@field report_contacts boolean # default false. Tell when this part begins to touch another.
---@field position vec3like # m, -1000000 .. 1000000. Origin of the link frame, world. The stability check restores the body from 10 km on.
---@field rotation quat # Link frame, world: x y z w.
---@field linear_velocity vec3like # m/s, -10000 .. 10000. Velocity of the centre of mass, world. The stability check restores the body from 500 m/s on.
---@field angular_velocity vec3like # rad/s, -10000 .. 10000. Angular velocity, world axes. The stability check restores the body from 1000 rad/s on, spin about a driven joint's axis or a principal axis not counted, and from 20000 rad/s in any case.
---@field center vec3 # read-only, m. Centre of mass, world.
---@field inertia vec3 # read-only, kg·m². Moments of inertia about the principal axes; static: 0.
---@field principal_axes quat # read-only. Principal axes of inertia, world: x y z w.
---@field rotation_clamped number # read-only, rad/s. Rotation held back in the last tick: clamped beyond π/4 per substep, spins about a driven joint's axis or a principal axis apart; 0: no clamp. More substeps lift it.
local part_ = {}

---@class part_opts
---@field mass? number # kg, 0.001 .. 1000000, default 1. Mass; the inertia scales with it. A part made with mass 0 never moves.
---@field linear_damping? number # 1/s, 0 .. 1, default 0. Fraction of the velocity lost per second.
---@field angular_damping? number # 1/s, 0 .. 1, default 0. Fraction of the angular velocity lost per second.
---@field friction? number # 0 .. 100, default 0.5. Coulomb friction; the values of two touching parts multiply.
---@field rolling_friction? number # m, 0 .. 100, default 0. Resistance to rolling; the values of two touching parts are mixed.
---@field spinning_friction? number # m, 0 .. 100, default 0. Resistance to spinning about the contact's normal; mixed like rolling friction.
---@field friction_direction? vec3like # -1 .. 1, default 0 0 0. Direction, link frame, in which friction is scaled by friction_factor; zeros: in none.
---@field friction_factor? number # 0 .. 100, default 1. Friction along friction_direction as a multiple of that across it.
---@field restitution? number # 0 .. 1, default 0. What a bounce gives back; the values of two touching parts multiply.
---@field self_collision? boolean # default true. Whether it collides with other parts of its body.
---@field collision_group? integer # 0 .. 65535, default 1. The groups it is in, a bit each (16). Two parts collide if each one's group has a bit in the other's mask.
---@field collision_mask? integer # 0 .. 65535, default 65535. The groups it collides with, a bit each (16).
---@field report_contacts? boolean # default false. Tell when this part begins to touch another.
---@field position? vec3like # m, -1000000 .. 1000000. Origin of the link frame, world. The stability check restores the body from 10 km on.
---@field rotation? quat # Link frame, world: x y z w.
---@field linear_velocity? vec3like # m/s, -10000 .. 10000. Velocity of the centre of mass, world. The stability check restores the body from 500 m/s on.
---@field angular_velocity? vec3like # rad/s, -10000 .. 10000. Angular velocity, world axes. The stability check restores the body from 1000 rad/s on, spin about a driven joint's axis or a principal axis not counted, and from 20000 rad/s in any case.

---Force in N for one tick, world; at a world point, else the centre. The stability check restores what exceeds 500 m/s.
---@param force vec3like
---@param at? vec3like
function part_:apply_force(force, at) end

---Impulse in N·s, world; at a world point, else the centre. The stability check restores what exceeds 500 m/s.
---@param impulse vec3like
---@param at? vec3like
function part_:apply_impulse(impulse, at) end

---Torque in N·m for one tick, world axes. The stability check restores what tumbles at 1000 rad/s.
---@param torque vec3like
function part_:apply_torque(torque) end

---What ties two parts. Its own axis is z of the joint's frame.
---@class joint
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists.
---@field type "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # read-only.
---@field body body # read-only.
---@field parent part # read-only.
---@field child part # read-only.
---@field motor? motor # read-only. nil when it has none.
---@field linear_lower_limit vec3like|number # m, -10000 .. 10000, default 0 0 0. Lower limit along each axis; equal to the upper: locked; above it: free.
---@field linear_upper_limit vec3like|number # m, -10000 .. 10000, default 0 0 0. Upper limit along each axis.
---@field angular_lower_limit vec3like|number # rad, -10000 .. 10000, default 0 0 0. Lower limit about each axis; equal to the upper: locked; above it: free.
---@field angular_upper_limit vec3like|number # rad, -10000 .. 10000, default 0 0 0. Upper limit about each axis; limits may lie beyond ±π.
---@field linear_stop_erp vec3like|number # 0 .. 1, default 0.2 0.2 0.2. Part of a lock's or limit's error that one internal step repairs, along.
---@field linear_stop_cfm vec3like|number # m/N, 0 .. 1, default 0 0 0. How far a lock or limit yields per load, along.
---@field angular_stop_erp vec3like|number # 0 .. 1, default 0.2 0.2 0.2. Part of a lock's or limit's error that one internal step repairs, about.
---@field angular_stop_cfm vec3like|number # rad/(N·m), 0 .. 1, default 0 0 0. How far a lock or limit yields per load, about.
---@field value number # read-only, m | rad. Where the own axis stands.
---@field speed number # read-only, m/s | rad/s. How fast the own axis moves.
---@field angles vec3 # read-only, rad. Angles in the joint's own order, the one its limits and servos act in.
---@field offsets vec3 # read-only, m. Shift of the child along the parent's joint axes.
---@field relrot vec3 # read-only, rad. Child's joint frame in the parent's, R = Rz·Ry·Rx, as the stream has it.
---@field position vec3 # read-only, m. The joint's point on the parent's side, world.
---@field rotation quat # read-only. The child's joint frame, world, its own rotation included: x y z w.
---@field axis vec3 # read-only. The own axis, world.
local joint_ = {}

---@class joint_opts
---@field type? "revolute"|"prismatic"|"spherical"|"planar"|"floating"|"fixed" # default "revolute".
---@field position? vec3like # m, world; left out: the child's.
---@field axis? vec3like # world, default 0 0 1.
---@field linear_lower_limit? vec3like|number # m, -10000 .. 10000, default 0 0 0. Lower limit along each axis; equal to the upper: locked; above it: free.
---@field linear_upper_limit? vec3like|number # m, -10000 .. 10000, default 0 0 0. Upper limit along each axis.
---@field angular_lower_limit? vec3like|number # rad, -10000 .. 10000, default 0 0 0. Lower limit about each axis; equal to the upper: locked; above it: free.
---@field angular_upper_limit? vec3like|number # rad, -10000 .. 10000, default 0 0 0. Upper limit about each axis; limits may lie beyond ±π.
---@field linear_stop_erp? vec3like|number # 0 .. 1, default 0.2 0.2 0.2. Part of a lock's or limit's error that one internal step repairs, along.
---@field linear_stop_cfm? vec3like|number # m/N, 0 .. 1, default 0 0 0. How far a lock or limit yields per load, along.
---@field angular_stop_erp? vec3like|number # 0 .. 1, default 0.2 0.2 0.2. Part of a lock's or limit's error that one internal step repairs, about.
---@field angular_stop_cfm? vec3like|number # rad/(N·m), 0 .. 1, default 0 0 0. How far a lock or limit yields per load, about.

---What moves a joint. Rows of three axes take a vec3, or one number for the own axis (booleans: for all axes).
---@class motor
---@field name string # read-only. The joint's.
---@field alive boolean # read-only. Whether it still exists.
---@field body body # read-only.
---@field joint joint # read-only.
---@field mode "off"|"spin"|"servo"|"spring" # What is in force on the own axis; setting it sets the three flags.
---@field target number # m | rad, -10000 .. 10000. Where the own axis's servo or spring goes; full turns count: 20π is ten.
---@field speed number # m/s | rad/s, -10000 .. 10000. Speed of the own axis's spin; how fast its servo may go. The stability check restores what moves at 500 m/s.
---@field bounce number # 0 .. 1, default 0. What a limit gives back: met at speed v, it is left at −bounce·v.
---@field damping number # N·s/m | N·m·s/rad, 0 .. 1000000, default 0. Passive damping of every free axis in any mode.
---@field target_smoothing number # s, 0 .. 2, default 0. Smooths targets that arrive at irregular times, best over two periods of the stream; motion is later by 1.5 times this and up to three ticks. 0: a target is reached in one tick.
---@field linear_active flags3|boolean[]|boolean # default false false false. Motor on along each axis: a spin, or a servo when that is active too.
---@field linear_velocity vec3like|number # m/s, -10000 .. 10000, default 0 0 0. Speed of a spin along each axis; how fast a servo may go (0: as fast as its force allows).
---@field max_linear_force vec3like|number # N, 0 .. 1000000000, default 10000 10000 10000. Most that a spin or servo applies along each axis.
---@field linear_servo_active flags3|boolean[]|boolean # default false false false. Servo on along each axis (needs the motor active).
---@field linear_servo_position vec3like|number # m, -10000 .. 10000, default 0 0 0. Where a servo goes along each axis.
---@field linear_spring_active flags3|boolean[]|boolean # default false false false. Spring on along each axis; spin and servo are off then.
---@field linear_spring_rest_length vec3like|number # m, -10000 .. 10000, default 0 0 0. Where a spring rests along each axis.
---@field linear_spring_stiffness vec3like|number # N/m, 0 .. 1000000, default 0 0 0. Spring stiffness along each axis.
---@field linear_spring_damping vec3like|number # N·s/m, 0 .. 1000000, default 0 0 0. Spring damping along each axis.
---@field linear_spring_stiffness_applied vec3 # read-only, N/m. Stiffness in force along each axis, held stable for the step.
---@field linear_spring_damping_applied vec3 # read-only, N·s/m. Spring damping in force along each axis.
---@field angular_active flags3|boolean[]|boolean # default false false false. Motor on about each axis: a spin, or a servo when that is active too.
---@field angular_velocity vec3like|number # rad/s, -10000 .. 10000, default 0 0 0. Speed of a spin about each axis; how fast a servo may go (0: as fast as its force allows).
---@field max_angular_force vec3like|number # N·m, 0 .. 1000000000, default 10000 10000 10000. Most that a spin or servo applies about each axis.
---@field angular_servo_active flags3|boolean[]|boolean # default false false false. Servo on about each axis (needs the motor active).
---@field angular_servo_position vec3like|number # rad, -10000 .. 10000, default 0 0 0. Where a servo goes about each axis; full turns count.
---@field angular_spring_active flags3|boolean[]|boolean # default false false false. Spring on about each axis; spin and servo are off then.
---@field angular_spring_rest_length vec3like|number # rad, -10000 .. 10000, default 0 0 0. Where a spring rests about each axis.
---@field angular_spring_stiffness vec3like|number # N·m/rad, 0 .. 1000000, default 0 0 0. Spring stiffness about each axis.
---@field angular_spring_damping vec3like|number # N·m·s/rad, 0 .. 1000000, default 0 0 0. Spring damping about each axis.
---@field angular_spring_stiffness_applied vec3 # read-only, N·m/rad. Stiffness in force about each axis, held stable for the step.
---@field angular_spring_damping_applied vec3 # read-only, N·m·s/rad. Spring damping in force about each axis.
---@field applied_force vec3 # read-only, N. What motors and springs applied along each axis, mean of the last tick; at a stop, what presses against it.
---@field applied_torque vec3 # read-only, N·m. What motors and springs applied about each axis, mean of the last tick; at a stop, what presses against it.
local motor_ = {}

---@class motor_opts
---@field mode? "off"|"spin"|"servo"|"spring" # What is in force on the own axis; setting it sets the three flags.
---@field target? number # m | rad, -10000 .. 10000. Where the own axis's servo or spring goes; full turns count: 20π is ten.
---@field speed? number # m/s | rad/s, -10000 .. 10000. Speed of the own axis's spin; how fast its servo may go. The stability check restores what moves at 500 m/s.
---@field bounce? number # 0 .. 1, default 0. What a limit gives back: met at speed v, it is left at −bounce·v.
---@field damping? number # N·s/m | N·m·s/rad, 0 .. 1000000, default 0. Passive damping of every free axis in any mode.
---@field target_smoothing? number # s, 0 .. 2, default 0. Smooths targets that arrive at irregular times, best over two periods of the stream; motion is later by 1.5 times this and up to three ticks. 0: a target is reached in one tick.
---@field linear_active? flags3|boolean[]|boolean # default false false false. Motor on along each axis: a spin, or a servo when that is active too.
---@field linear_velocity? vec3like|number # m/s, -10000 .. 10000, default 0 0 0. Speed of a spin along each axis; how fast a servo may go (0: as fast as its force allows).
---@field max_linear_force? vec3like|number # N, 0 .. 1000000000, default 10000 10000 10000. Most that a spin or servo applies along each axis.
---@field linear_servo_active? flags3|boolean[]|boolean # default false false false. Servo on along each axis (needs the motor active).
---@field linear_servo_position? vec3like|number # m, -10000 .. 10000, default 0 0 0. Where a servo goes along each axis.
---@field linear_spring_active? flags3|boolean[]|boolean # default false false false. Spring on along each axis; spin and servo are off then.
---@field linear_spring_rest_length? vec3like|number # m, -10000 .. 10000, default 0 0 0. Where a spring rests along each axis.
---@field linear_spring_stiffness? vec3like|number # N/m, 0 .. 1000000, default 0 0 0. Spring stiffness along each axis.
---@field linear_spring_damping? vec3like|number # N·s/m, 0 .. 1000000, default 0 0 0. Spring damping along each axis.
---@field angular_active? flags3|boolean[]|boolean # default false false false. Motor on about each axis: a spin, or a servo when that is active too.
---@field angular_velocity? vec3like|number # rad/s, -10000 .. 10000, default 0 0 0. Speed of a spin about each axis; how fast a servo may go (0: as fast as its force allows).
---@field max_angular_force? vec3like|number # N·m, 0 .. 1000000000, default 10000 10000 10000. Most that a spin or servo applies about each axis.
---@field angular_servo_active? flags3|boolean[]|boolean # default false false false. Servo on about each axis (needs the motor active).
---@field angular_servo_position? vec3like|number # rad, -10000 .. 10000, default 0 0 0. Where a servo goes about each axis; full turns count.
---@field angular_spring_active? flags3|boolean[]|boolean # default false false false. Spring on about each axis; spin and servo are off then.
---@field angular_spring_rest_length? vec3like|number # rad, -10000 .. 10000, default 0 0 0. Where a spring rests about each axis.
---@field angular_spring_stiffness? vec3like|number # N·m/rad, 0 .. 1000000, default 0 0 0. Spring stiffness about each axis.
---@field angular_spring_damping? vec3like|number # N·m·s/rad, 0 .. 1000000, default 0 0 0. Spring damping about each axis.

---Couples two joints both ways: position of b = ratio * position of a + offset. Made by sim:add_gear.
---@class gear
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists; it goes with its joints' bodies.
---@field joint_a joint # read-only.
---@field joint_b joint # read-only.
---@field enabled boolean # default true. False: the joints are free of each other.
---@field ratio number # -1000000 .. 1000000, default 1. Travel of joint b per travel of joint a; not 0.
---@field offset number # m | rad, -10000 .. 10000, default 0. Position of joint b where joint a is at 0.
---@field max_force number # N | N·m, 0 .. 1000000000, default 0. Largest force or torque on joint b's axis; beyond it the gear slips. 0: no limit.
---@field error number # read-only, m | rad. How far joint b is from its position by the gear.
---@field force number # read-only, N | N·m. Force or torque on joint b's axis, mean of the last tick; joint a gets −ratio times this.
local gear_ = {}

---Removes the gear.
function gear_:remove() end

---@class gear_opts
---@field name? string # Left out: the names of both joints.
---@field enabled? boolean # default true. False: the joints are free of each other.
---@field ratio? number # -1000000 .. 1000000, default 1. Travel of joint b per travel of joint a; not 0.
---@field offset? number # m | rad, -10000 .. 10000, default 0. Position of joint b where joint a is at 0.
---@field max_force? number # N | N·m, 0 .. 1000000000, default 0. Largest force or torque on joint b's axis; beyond it the gear slips. 0: no limit.

---What parts look like and touch with.
---@class shape
---@field name string # read-only.
---@field alive boolean # read-only. Whether it still exists.
---@field transparency number # 0 .. 1, default 0. 0: nothing shines through; 1: not to be seen.
---@field ambient_scale number # 0 .. 10, default 0.5. How much light from everywhere counts.
---@field diffuse_scale number # 0 .. 10, default 0.5. How much the lamps' light counts.
---@field specular_scale number # 0 .. 10, default 0.5. How bright highlights are.
---@field specular_pow number # 0 .. 1000, default 10. How small highlights are.
---@field ambient_color vec3like # hsb, 0 .. 1, default 0 0 1. In light from everywhere: hue, saturation, brightness.
---@field diffuse_color vec3like # hsb, 0 .. 1, default 0 0 1. In the lamps' light: hue, saturation, brightness.
local shape_ = {}

---Adds a shape to a compound one.
---@param child shape|string
---@param position? vec3like # m
---@param rotation? quat
---@return shape
function shape_:add_child(child, position, rotation) end

---A link of a URDF file; a merged one keeps its frame.
---@class link
---@field name string # read-only.
---@field alive boolean # read-only. Whether its body still exists.
---@field body body # read-only.
---@field position vec3 # read-only, m, world.
---@field rotation quat # read-only, world.

---@class body_list
---@field [integer] body
---@overload fun(self: sim, wanted?: string|body|(string|body)[]): fun(): body, integer

---@class behavior_list
---@field [integer] behavior
---@overload fun(self: body, wanted?: string|behavior|(string|behavior)[]): fun(): behavior, integer

---@class part_list
---@field [integer] part
---@overload fun(self: body, wanted?: string|part|(string|part)[]): fun(): part, integer

---@class joint_list
---@field [integer] joint
---@overload fun(self: body, wanted?: string|joint|(string|joint)[]): fun(): joint, integer

---@class gear_list
---@field [integer] gear
---@overload fun(self: sim, wanted?: string|gear|(string|gear)[]): fun(): gear, integer

---@class motor_list
---@field [integer] motor
---@overload fun(self: body, wanted?: string|motor|(string|motor)[]): fun(): motor, integer

-- The world, and when a scene acts in it.

---The world. The top level of a scene describes what exists; callbacks act.
---@class sim
---@field alive boolean # read-only. Always true.
---@field bodies body_list # read-only. In stream order; called, it walks those that a pattern matches.
---@field collision_groups string[] # Names of the 16 collision groups, in order of their bits; set at the top level.
---@field gears gear_list # read-only. Made by add_gear, in stream order.
---@field gravity vec3like # m/s², -10000 .. 10000, default 0 0 -9.81. Acceleration of everything that moves.
---@field timestep number # s, 1e-05 .. 1, default 0.0166667. What a tick advances the time by.
---@field substeps integer # 1 .. 1000, default 4. Equal internal steps that a tick is made of.
---@field solver_iterations integer # 1 .. 10000, default 50. Rounds of the contact and joint solver in each internal step.
---@field panic_motors "held"|"limp" # default held. What motors do while a panic holds: stay where they are, with their own strength, or nothing.
---@field solver "iterative"|"direct" # default direct. How joints are solved: in rounds with the contacts, or exactly, as trees.
---@field seed integer # 0 .. 9007199254740992. What every random draw derives from: a behaviour's at once, a scene's from the next start.
---@field paused boolean # Time stands still; commands and OSC are still answered.
---@field speed number # × real time, 0.01 .. 100. How fast simulated time runs when it is paced.
---@field history number # s, 0 .. 30. Of the past that is kept for /transport/rewind; 0: nothing.
---@field time number # read-only, s. Simulated time.
---@field tick integer # read-only. Ticks since the start.
---@field panicked boolean # read-only. A panic holds: everything comes to rest.
---@field solver_fallbacks integer # read-only. Steps of islands that the direct solver left to the iterative one, since the start.
---@field sleeping_parts integer # read-only. Parts that are asleep, at rest.
---@field islands_direct integer # read-only. Steps of islands (parts that joints or contacts connect) that the direct solver solved, since the start.
---@field islands_iterative integer # read-only. Steps of islands that the iterative solver solved, by rule or as a fallback, since the start.
sim = {}

---A body from a URDF file.
---@param path string
---@param opts? urdf_opts
---@return body
function sim:load_urdf(path, opts) end

---@class urdf_opts: body_opts
---@field name? string # Left out: the robot's.
---@field fixed_base? boolean # Left out: as the mass of its root says.
---@field keep_fixed? boolean # default false. Links behind fixed joints stay parts of their own.
---@field motors? "servo"|"off" # default "servo".
---@field pose? table<string, number> # Joint = value, rad or m.
---@field package_path? string|string[] # Where package:// is looked for.

---An empty body.
---@param name string
---@param opts? body_opts
---@return body
function sim:add_body(name, opts) end

---Attaches a behaviour to several bodies, an instance each. What is written to the group goes to every member.
---@param type string # Case, underscores and a trailing "behavior" don't matter.
---@param name string
---@param opts? group_opts
---@return behavior_group
function sim:add_group_behavior(type, name, opts) end

---A group by its name.
---@param name string|behavior_group
---@return behavior_group
function sim:group_behavior(name) end

---Couples the own axes of two joints, of one body or of two, both ways: position of b = ratio * position of a + offset.
---@param joint_a joint # Revolute, continuous or prismatic.
---@param joint_b joint
---@param ratio number # Travel of b per travel of a; not 0.
---@param opts? gear_opts # `offset` left out: from the present positions.
---@return gear
function sim:add_gear(joint_a, joint_b, ratio, opts) end

---A gear by its name or number (-1: the last).
---@param key string|integer|gear
---@return gear
function sim:gear(key) end

---A body by its name or number (-1: the last). An error with the near names when there is none.
---@param key string|integer|body
---@return body
function sim:body(key) end

---A body by its name, or nil.
---@param name string
---@return body?
function sim:find_body(name) end

---A plane that never ends.
---@param name string
---@param normal? vec3like # default 0 0 1.
---@return shape
function sim:add_plane_shape(name, normal) end

---A ball.
---@param name string
---@param radius number # m
---@return shape
function sim:add_sphere_shape(name, radius) end

---A box.
---@param name string
---@param size vec3like # m, full edges
---@return shape
function sim:add_box_shape(name, size) end

---A cylinder, along z.
---@param name string
---@param radius number # m
---@param height number # m
---@return shape
function sim:add_cylinder_shape(name, radius, height) end

---A cylinder with round caps, along z.
---@param name string
---@param radius number # m
---@param height number # m, without the caps
---@return shape
function sim:add_capsule_shape(name, radius, height) end

---A cone, along z.
---@param name string
---@param radius number # m
---@param height number # m
---@return shape
function sim:add_cone_shape(name, radius, height) end

---@class mesh_opts
---@field scale? number|vec3like # default 1.
---@field max_vertices? integer # 4 .. 255, default 64 of a file, 255 of a list.

---The hull of a mesh file, or of points.
---@param name string
---@param source string|vec3like[]
---@param opts? mesh_opts
---@return shape
function sim:add_convex_mesh_shape(name, source, opts) end

---A shape made of others, by `shape:add_child`.
---@param name string
---@return shape
function sim:add_compound_shape(name) end

---At the start and after each reset.
---@param f fun()
function sim:on_start(f) end

---In each tick, before the physics.
---@param f fun(dt: number)
function sim:on_step(f) end

---When a part with `report_contacts` begins to touch: impulse in N·s, position in m.
---@param f fun(part: part, other: part, impulse: number, position: vec3)
function sim:on_contact(f) end

---Calls f each time the simulated time passes a multiple of `seconds`. A timer set in a callback continues unchanged after a save.
---@param seconds number
---@param f fun()
---@return timer
function sim:every(seconds, f) end

---Calls f once, `seconds` from now. A timer set in a callback continues after a save; one at the top level keeps its time.
---@param seconds number
---@param f fun()
---@return timer
function sim:after(seconds, f) end

---Once, at that simulated time.
---@param time number # s
---@param f fun()
---@return timer
function sim:at(time, f) end

---The scene from its start, with the performer's values.
function sim:reset() end

---All comes to rest: behaviours, morphs, forces and the scene's callbacks stop. Once more, after the first second: back to the newest good moment.
function sim:panic() end

---Text that is the same when the world is the same to the bit.
---@return string
function sim:state_hash() end

---@class timer
local timer_ = {}

---It does not come any more.
function timer_:cancel() end

-- What the picture is drawn with.

---The picture: its background, the camera, the look, the materials of the shapes.
---@class visuals
---@field alive boolean # read-only. Always true.
---@field camera camera # read-only.
---@field look look # read-only.
---@field background vec3like # hsb, 0 .. 1, default 0.62 0.45 0.06. Behind everything, as hue, saturation, brightness; the default: as the look has it.
visuals = {}

---A shape by its name, whose rows are its material. Those of a URDF file are called robot.link, robot.link.2, …
---@param key string|integer|shape
---@return shape
function visuals:shape(key) end

---The camera. The view is T(position)·Rx·Ry·Rz, in degrees; eye and target are the same in world terms.
---@class camera
---@field alive boolean # read-only. Always true.
---@field projection number[] # { fovy, aspect, near, far }.
---@field position vec3like # m, -1000000 .. 1000000, default -8.88178e-16 -0.948683 -8.22192. The world's origin, as the eye has it before it is turned; z below 0 is in front.
---@field rotation vec3like # deg, -36000 .. 36000, default -71.5651 0 -36.8699. Turns the world: about z, then y, then x.
---@field fovy number # deg, 1 .. 170, default 40. Field of view from bottom to top.
---@field aspect number # 0 .. 100, default 0. Width by height of the picture; 0: the window's.
---@field near number # m, 0.0001 .. 10000, default 0.05. What is nearer is not drawn.
---@field far number # m, 0.01 .. 10000000, default 200. What is further away is not drawn.
---@field distance number # m, 0.001 .. 1000000, default 7.90569. From the eye to the target.
---@field eye vec3like # m, -1000000 .. 1000000. Where it looks from, world; the target stays.
---@field target vec3like # m, -1000000 .. 1000000. What it looks at, world; the eye stays.
local camera_ = {}

---Looks from one point at another, upright: at once, or (in callbacks) in so many seconds of simulation time, slow at
---both ends. A hand on the camera ends the way there.
---@param eye vec3like
---@param target vec3like
---@param seconds? number # above 0.
function camera_:look_at(eye, target, seconds) end

---Looks at a part, or at the root of a body, and goes with it (in callbacks); distance and direction stay, and a hand may
---change them. nil: goes with nothing.
---@param thing body|part|nil
function camera_:follow(thing) end

---How the picture is lit, and its stage.
---@class look
---@field alive boolean # read-only. Always true.
---@field style "stage"|"studio" # default stage. A dark stage with a spotlight and a mirroring floor, or a bright studio. The rows below are multiples of what it has.
---@field exposure number # 0 .. 16, default 1. How bright the picture is; what is too bright turns white softly.
---@field ambient number # 0 .. 10, default 1. Light from everywhere, in the background's tint.
---@field lamp number # 0 .. 10, default 1. The one lamp that casts shadows.
---@field rim number # 0 .. 10, default 1. Light from behind, along the edges of shapes.
---@field shadow number # 0 .. 1, default 1. How dark shadows are; 0: none.
---@field fog number # 0 .. 10, default 1. How soon distance turns into background.
---@field grid number # 0 .. 10, default 1. How plain the lines on the floor are, a metre apart.
---@field mirror number # 0 .. 3, default 1. How much the floor mirrors; the studio's does not.
---@field floor boolean # default true. A floor at height 0, where no plane of the scene is one.
---@field overlay boolean # Joint axes and limits, centres of mass, forces, contacts and targets over the picture.
local look_ = {}

---Takes a style by its number (0: stage, 1: studio), unless the scene says which one it has.
---@param style integer
function look_:prefer(style) end

-- A scene's own parameters and state, and OSC.

---A parameter. Its default gives the type: number, boolean, vec3, or text with choices.
---@class param
---@field [1] string # Its name: letters, digits, _.
---@field [2] number|boolean|vec3like|string # Its default.
---@field min? number|vec3like
---@field max? number|vec3like
---@field step? number # What a turn of a wheel changes.
---@field unit? string
---@field doc? string
---@field choices? string[]

---The scene's own parameters: declared once by `params { … }`, in this order in the panel, /scene/<name> over OSC.
---@class params
---@field [string] any
---@overload fun(list: param[])
params = {}

---Plain data of the scene; it survives a reload and is emptied by a reset.
---@type table<string, any>
state = {}

---@class osc
---@field address? string # read-only. While a handler runs: the message's address.
---@field sender? string # read-only. While a handler runs: who sent it, such as 127.0.0.1:4000.
osc = {}

---A handler of messages whose address fits the pattern, with their numbers, text and booleans. Mind: 0 is true in Lua.
---@param pattern string
---@param f fun(...: any)
function osc:on(pattern, f) end

---A message to every target.
---@param address string
---@param ... number|string|boolean|vec3like
function osc:send(address, ...) end

---A message to the sender of the one that is handled now.
---@param address string
---@param ... number|string|boolean|vec3like
function osc:reply(address, ...) end

---Listens for OSC on a port of this machine, instead of the default.
---@param port integer # 1 .. 65535
function osc:listen(port) end

---@class stream_opts
---@field rate? number # Hz, 0.1 .. 1000, default 60.
---@field streams? string|string[] # Of pos, rot, relrot, relpos; default pos+rot+relrot.
---@field bodies? string|body # A name or a pattern, default all.
---@field bundle? integer|false|"off" # 1472, 8192 or 65504 bytes, or "off".
---@field errors? boolean # default false. Refusals are told there too.

---Streams the joints' poses to a host, instead of the default.
---@param target string # host:port
---@param opts? stream_opts
function osc:stream_to(target, opts) end

---An address to send to.
---@param target string # host:port
---@return address
function osc:to(target) end

---@class address
local address_ = {}

---A message to this address alone.
---@param address string
---@param ... number|string|boolean|vec3like
function address_:send(address, ...) end

-- Presets: the named states of the show.

---Named copies of values, in order, kept in a file beside the scene. What a callback asks of them is done once the
---callbacks of the tick are. The preset "script" is always there: every property as the scene describes it.
---@class presets
---@field names string[] # read-only. Of all but "script", in their order.
presets = {}

---@class preset_opts
---@field rows? string|string[] # Patterns of what is kept, "behaviors" or "looks"; left out: every property.
---@field except? string|string[] # Patterns of what a recall leaves alone.
---@field poses? boolean # With where every part is.
---@field velocities? boolean # With how it moves.

---Keeps values as they are now. One of that name is replaced; without options it is made of what it was made of before.
---@param name string
---@param opts? preset_opts
function presets:store(name, opts) end

---Brings values back, at once or over simulated seconds. 2.5 is half-way between the second and the third preset.
---@param which string|number
---@param seconds? number
---@param easing? "smooth"|"linear"|"in"|"out" # default "smooth".
function presets:recall(which, seconds, easing) end

---Sets what lies between two presets.
---@param a string|integer
---@param b string|integer
---@param amount number # 0: the first, 1: the second.
function presets:morph(a, b, amount) end

---Forgets a preset.
---@param which string|integer
function presets:delete(which) end

-- Files of behaviors_lua: each returns a behavior { … }.

---What a file of behaviors_lua returns. The type's name is the file's name.
---@class behavior_definition
---@field doc? string # What it does, in a sentence.
---@field params? param[] # In this order in the panel.
---@field group? boolean # default false. It is attached by sim:add_group_behavior, one instance for each body.
---@field start? fun(self: behavior_self) # Before the first step, after each reset, and when its parts or motors have changed.
---@field step? fun(self: behavior_self, dt: number) # In each tick while it is active.
---@field migrate? fun(self: behavior_self, old_state: table<string, any>): table<string, any> # When its file was saved.

---Declares a behaviour.
---@param definition behavior_definition
---@return behavior_definition
function behavior(definition) end

---What the functions of a behaviour get: its parameters by their names, and these.
---@class behavior_self
---@field active boolean
---@field place integer # Which one it is, from 1, of those that act on its body in a tick.
---@field name string # read-only.
---@field alive boolean # read-only. Whether it is still attached.
---@field type string # read-only.
---@field body body # read-only.
---@field parts part_list # read-only.
---@field joints joint_list # read-only.
---@field motors motor_list # read-only.
---@field neighbor_parts part_list # read-only. Of the other bodies; only of a group.
---@field time number # read-only, s.
---@field state table<string, any> # Plain data; it survives a reload.
---@field rng rng # read-only. Its own generator.
---@field [string] any # Its parameters.
local behavior_self_ = {}

---True at the first active tick after `start`, and then every so many simulated milliseconds.
---@param interval string # The parameter that holds the milliseconds.
---@return boolean
function behavior_self_:due(interval) end

---The neighbours of a part: for other, offset, distance in self:neighbors(part, radius) do … Only of a group.
---@param part part
---@param radius number # m
---@return fun(): part, vec3, number
function behavior_self_:neighbors(part, radius) end

---Means over the neighbours between two distances, found for the whole group at once: how many there are, the way to
---their middle (m), their mean velocity less the part's own (m/s), and the same of angular velocities (rad/s). Zeros
---without neighbours. Only of a group.
---@param part part
---@param min_dist number # m
---@param max_dist number # m
---@return integer
---@return vec3
---@return vec3
---@return vec3
function behavior_self_:neighbor_means(part, min_dist, max_dist) end

---The mean over the neighbours between two distances of: a unit vector to the neighbour, times 1 - distance / max_dist.
---It points to where it is crowded. Zero without neighbours. Only of a group.
---@param part part
---@param min_dist number # m
---@param max_dist number # m
---@return vec3
function behavior_self_:neighbor_push(part, min_dist, max_dist) end

---A behaviour that is attached to a body; its parameters are properties.
---@class behavior
---@field name string # read-only.
---@field alive boolean # read-only. Whether it is still attached.
---@field type string # read-only.
---@field body body # read-only.
---@field active boolean # default true. Setting it, to whatever, lets one that failed try again.
---@field place integer # Which one it is, from 1, of those that act on its body in a tick; setting it puts it there.
---@field error? string # read-only. Why it rests although it is active.
---@field time number # read-only, µs. What the last tick spent on it.
---@field parts part_list # read-only.
---@field joints joint_list # read-only.
---@field motors motor_list # read-only.
---@field [string] any # Its parameters.
local behavior_ = {}

---Detaches it.
function behavior_:remove() end

---@class behavior_opts
---@field parts? string|integer|part|(string|part)[] # Names, patterns, "all".
---@field joints? string|joint|(string|joint)[]
---@field motors? string|motor|(string|motor)[]
---@field active? boolean # default true.
---@field [string] any # The type's parameters.

---A behaviour of several bodies.
---@class behavior_group
---@field name string # read-only.
---@field alive boolean # read-only.
---@field type string # read-only.
---@field active boolean # default true. Setting it sets that of every member.
---@field place integer # Which one it is, from 1, of all names of behaviours; setting it puts it there.
---@field time number # read-only, µs. What the last tick spent on all of it.
---@field [string] any # Its parameters: what is written goes to every member.
local behavior_group_ = {}

---Takes it away from all its members.
function behavior_group_:remove() end

---@class group_opts
---@field bodies? string|body|(string|body)[] # default "all".
---@field parts? string|(string)[] # default "all". The own parts that it acts on.
---@field neighbor_parts? string|(string)[] # Left out: as parts. Those that are looked at.
---@field active? boolean # default true.
---@field [string] any # The type's parameters.

-- Beside these, scripts see the following names of Lua's own, as LuaJIT has them:
-- assert bit bit.arshift bit.band bit.bnot bit.bor bit.bswap bit.bxor bit.lshift bit.rol bit.ror bit.rshift
-- bit.tobit bit.tohex collectgarbage coroutine coroutine.create coroutine.resume coroutine.running coroutine.status
-- coroutine.wrap coroutine.yield error getmetatable ipairs load loadstring math math.abs math.acos math.asin
-- math.atan math.atan2 math.ceil math.cos math.cosh math.deg math.exp math.floor math.fmod math.frexp math.huge
-- math.ldexp math.log math.log10 math.max math.min math.modf math.pi math.pow math.rad math.random math.sin
-- math.sinh math.sqrt math.tan math.tanh pairs pcall print rawequal rawget rawset require select setmetatable
-- string string.byte string.char string.find string.format string.gmatch string.gsub string.len string.lower
-- string.match string.rep string.reverse string.sub string.upper table table.concat table.insert table.maxn
-- table.remove table.sort tonumber tostring type unpack xpcall
