-- Settings for rendering.

---Rendering: background, camera, look, materials of the shapes.
---@class visuals
---@field alive boolean # read-only. Always true.
---@field camera camera # read-only.
---@field look look # read-only.
---@properties visuals
visuals = {}

---Returns a shape by name; its properties are its material. Shapes of a URDF file: robot.link, robot.link.2, …
---@param key string|integer|shape
---@return shape
function visuals:shape(key) end

---The camera. The view matrix is T(position)·Rx·Ry·Rz, in degrees; eye and target describe the same view in world
---coordinates.
---@class camera
---@field alive boolean # read-only. Always true.
---@field projection number[] # { fovy, aspect, near, far }.
---@properties camera
local camera_ = {}

---Looks from one point at another, upright: at once, or (in callbacks) with a transition of some seconds of simulation
---time that eases in and out. Moving the camera by hand ends the transition.
---@param eye vec3like
---@param target vec3like
---@param seconds? number # above 0.
function camera_:look_at(eye, target, seconds) end

---Makes the camera follow a part, or the root of a body (in callbacks). Distance and direction stay the same and can be
---changed by hand. nil: stop following.
---@param thing body|part|nil
function camera_:follow(thing) end

---Lighting, and the ground.
---@class look
---@field alive boolean # read-only. Always true.
---@properties look
local look_ = {}

---Selects a style by number (0: stage, 1: studio), unless the scene sets one.
---@param style integer
function look_:prefer(style) end
