-- `visuals`: settings for rendering: background, camera, look, materials of shapes.
local P = ...
local api, ctx = P.api, P.ctx
local fail, describe, classes = P.fail, P.describe, P.classes
local class, camera, look = classes.visuals, classes.camera, classes.look
local shapes = 4

P.derive_members(class)
P.derive_members(camera)
P.derive_members(look)
class.getters.alive, camera.getters.alive, look.getters.alive = P.alive, P.alive, P.alive

class.methods.shape = function(h, key)
  P.check_self(h, class, "shape")
  return P.find_in(P.sim, shapes, key)
end

-- four properties as one value
local projection_members = { "fovy", "aspect", "near", "far" }
camera.getters.projection = function(h)
  local value = {}
  for i, name in ipairs(projection_members) do value[i] = camera.getters[name](h) end
  return value
end
camera.setters.projection = function(h, value)
  if type(value) ~= "table" or #value ~= 4 then
    fail("visuals.camera: 'projection' takes { fovy, aspect, near, far }, not %s", describe(value))
  end
  for i, name in ipairs(projection_members) do P.check_number(value[i], "visuals.camera: " .. name) end
  if value[4] <= value[3] then fail("visuals.camera: far must be greater than near") end
  for i, name in ipairs(projection_members) do camera.setters[name](h, value[i]) end
end

camera.methods.look_at = function(h, eye, target, seconds)
  P.check_self(h, camera, "look_at")
  eye, target = P.check_vec3(eye, "look_at: the eye"), P.check_vec3(target, "look_at: the target")
  if seconds ~= nil then
    if P.check_number(seconds, "look_at: the seconds") <= 0 then
      fail("look_at takes seconds above 0, not %s; without seconds the change is immediate", tostring(seconds))
    end
    P.needs_callback("camera:look_at with seconds")
    if api.camera_glide(ctx, eye.x, eye.y, eye.z, target.x, target.y, target.z, seconds) ~= 0 then
      fail("look_at takes finite numbers, not %s and %s", describe(eye), describe(target))
    end
    return
  end
  -- a view whose eye and target are equal is ignored: the eye again, and a detour where the two are swapped
  if camera.getters.eye(h) == target and camera.getters.target(h) == eye then
    camera.setters.eye(h, (eye + target) / 2)
  end
  camera.setters.eye(h, eye)
  camera.setters.target(h, target)
  camera.setters.eye(h, eye)
end

camera.methods.follow = function(h, object)
  P.check_self(h, camera, "follow")
  P.needs_callback("camera:follow")
  if object == nil then return api.camera_follow(ctx, -1, 0) end
  local kind = P.class_of(object)
  if kind ~= classes.body and kind ~= classes.part then
    fail("camera:follow takes a body, a part, or nil, not %s", describe(object))
  end
  if not object.alive then P.fail_removed(object) end
  api.camera_follow(ctx, object.slot_, object.generation_)
end

local camera_handle = P.handle_of(P.camera_slot, P.camera_generation)
class.getters.camera = function() return camera_handle end
local look_handle = P.handle_of(P.look_slot, P.look_generation)
class.getters.look = function() return look_handle end

P.finish_class(class)
P.finish_class(camera)
P.finish_class(look)
P.visuals = P.handle_of(P.visuals_slot, P.visuals_generation)
