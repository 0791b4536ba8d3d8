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
