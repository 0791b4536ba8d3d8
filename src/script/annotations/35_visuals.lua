-- What the picture is drawn with.

---The picture: its background, the camera, the look, the materials of the shapes.
---@class visuals
---@field alive boolean # read-only. Always true.
---@field camera camera # read-only.
---@field look look # read-only.
---@rows visuals
visuals = {}

---A shape by its name, whose rows are its material. Those of a URDF file are called robot.link, robot.link.2, …
---@param key string|integer|shape
---@return shape
function visuals:shape(key) end

---The camera. The view is T(position)·Rx·Ry·Rz, in degrees; eye and target are the same in world terms.
---@class camera
---@field alive boolean # read-only. Always true.
---@field projection number[] # { fovy, aspect, near, far }.
---@rows camera
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
---@rows look
local look_ = {}

---Takes a style by its number (0: stage, 1: studio), unless the scene says which one it has.
---@param style integer
function look_:prefer(style) end
