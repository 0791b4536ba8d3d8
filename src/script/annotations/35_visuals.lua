-- Settings for rendering.

---@page visuals

---Rendering: background, camera, look, materials of the shapes.
---@class visuals
---@field alive boolean # read-only. Always true.
---@field camera camera # read-only. The camera.
---@field look look # read-only. Light and ground.
---@properties visuals
---@see camera, look
---@example colors
visuals = {}

---Returns a shape by name; its properties are its material. Shapes of a URDF file: robot.link, robot.link.2, …
---@param key string|integer|shape # Its name.
---@return shape
---@error visuals:shape("bal") --> there is no shape 'bal'; did you mean 'ball'?
---@see shape
---@example materials_of_shapes
function visuals:shape(key) end

---The camera. The view matrix is T(position)·Rx·Ry·Rz, in degrees; eye and target describe the same view in world
---coordinates.
---@class camera
---@field alive boolean # read-only. Always true.
---@field projection number[] # { fovy, aspect, near, far }.
---@properties camera
---@see camera:look_at, camera:follow
---@example camera
local camera_ = {}

---Looks from one point at another, upright: at once, or (in callbacks) with a transition of some seconds of simulation
---time that eases in and out. Moving the camera by hand ends the transition.
---@param eye vec3like # m, world.
---@param target vec3like # m, world.
---@param seconds? number # above 0.
---@see camera.eye, camera.target
---@example camera
function camera_:look_at(eye, target, seconds) end

---Makes the camera follow a part, or the root of a body (in callbacks). Distance and direction stay the same and can be
---changed by hand. nil: stop following.
---@param thing body|part|nil # A part, a body, or nil.
---@error visuals.camera:follow(body) --> camera:follow acts on the running scene; at the top level use sim:on_start(function() … end)
---@see camera.distance
---@example following
function camera_:follow(thing) end

---Lighting, and the ground.
---@class look
---@field alive boolean # read-only. Always true.
---@properties look
---@error visuals.look.style = "stadium" --> visuals.look: 'style' can't be 'stadium'; there are: stage, studio
---@see visuals.background
---@example look
local look_ = {}

---Selects a style by number (0: stage, 1: studio), unless the scene sets one.
---@param style integer # 0 or 1.
---@see look.style
---@example look
function look_:prefer(style) end
