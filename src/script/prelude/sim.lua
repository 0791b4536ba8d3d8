-- `sim`: the world's properties, shapes, bodies, model files, gears.
local P = ...
local ffi, api, ctx = P.ffi, P.api, P.ctx
local fail, describe, classes = P.fail, P.describe, P.classes
local class = classes.sim
local bodies, shapes = 0, 4

P.derive_members(class)
class.getters.alive = P.alive
class.getters.bodies = function(h) return P.list_of(h, bodies) end

local function method(name, f)
  class.methods[name] = function(h, ...)
    P.check_self(h, class, name)
    return f(h, ...)
  end
end
P.sim_method = method

method("body", function(h, key) return P.find_in(h, bodies, key) end)
method("find_body", function(h, name)
  P.check_text(name, "sim:find_body")
  if api.find(ctx, h.slot_, h.generation_, bodies, name, #name) ~= 0 then return nil end
  return P.answered_handle()
end)
method("add_body", function(_, name, opts)
  P.check_text(name, "add_body: the name")
  P.check_opts(classes.body, opts, {}, "add_body")
  return P.finish_creation(api.add_body(ctx, name, #name), classes.body, opts, {})
end)

-- the names of collision group bits
class.getters.collision_groups = function()
  local names = {}
  for i, name in ipairs(P.collision_groups) do names[i] = name end
  return names
end
class.setters.collision_groups = function(_, names)
  if P.answer.top_level == 0 then
    fail("sim.collision_groups must be set at the top level of the scene")
  end
  if type(names) ~= "table" or #names > 16 then fail("sim.collision_groups is a list of at most 16 names") end
  local seen, list = {}, {}
  for i, name in ipairs(names) do
    P.check_text(name, "sim.collision_groups: name " .. i)
    if seen[name] then fail("sim.collision_groups: duplicate name '%s'", name) end
    seen[name], list[i] = true, name
  end
  P.collision_groups = list
end

-- shapes
local numbers = ffi.new("double[3]")
local function add_shape(name, kind, x, y, z)
  P.check_text(name, "add_" .. kind .. "_shape: the name")
  numbers[0], numbers[1], numbers[2] = x or 0, y or 0, z or 0
  P.handle_result(api.add_shape(ctx, name, #name, kind, numbers))
  return P.answered_handle()
end
method("add_plane_shape", function(_, name, normal)
  local n = P.check_vec3(normal == nil and { 0, 0, 1 } or normal, "add_plane_shape: the normal")
  return add_shape(name, "plane", n.x, n.y, n.z)
end)
method("add_sphere_shape", function(_, name, radius)
  return add_shape(name, "sphere", P.check_number(radius, "add_sphere_shape: the radius"))
end)
method("add_box_shape", function(_, name, size)
  local s = P.check_vec3(size, "add_box_shape: the size (full edges)")
  return add_shape(name, "box", s.x, s.y, s.z)
end)
method("add_ellipsoid_shape", function(_, name, radii)
  local r = P.check_vec3(radii, "add_ellipsoid_shape: the radii")
  return add_shape(name, "ellipsoid", r.x, r.y, r.z)
end)
for _, kind in ipairs { "cylinder", "capsule", "cone" } do
  method("add_" .. kind .. "_shape", function(_, name, radius, height)
    local subject = "add_" .. kind .. "_shape: the "
    P.check_number(radius, subject .. "radius")
    return add_shape(name, kind, radius, P.check_number(height, subject .. "height"))
  end)
end
method("add_compound_shape", function(_, name) return add_shape(name, "compound") end)

local mesh_opts = { scale = true, max_vertices = true, concave = true }
method("add_convex_mesh_shape", function(_, name, source, opts)
  local subject = "add_convex_mesh_shape"
  P.check_text(name, subject .. ": the name")
  P.check_opts({ setters = {} }, opts, mesh_opts, subject)
  opts = opts or {}
  local from_file = type(source) == "string"
  if not from_file and type(source) ~= "table" then
    fail("%s takes a file's name or a list of vec3, not %s", subject, describe(source))
  end
  local scale = opts.scale == nil and 1 or opts.scale
  if type(scale) == "number" then scale = P.V(scale, scale, scale) end
  scale = P.check_vec3(scale, subject .. ": scale")
  local max_vertices = P.check_number(opts.max_vertices or (from_file and 64 or 255), subject .. ": max_vertices")
  if max_vertices < 4 or max_vertices > 255 then
    fail("%s: max_vertices is 4 .. 255, not %s", subject, tostring(max_vertices))
  end
  local concave = opts.concave
  if concave ~= nil and type(concave) ~= "boolean" then
    fail("%s: concave is true or false, not %s", subject, describe(concave))
  end
  if concave and not from_file then fail("%s: concave needs the surface of a mesh file, not points", subject) end
  for _, x in ipairs { scale.x, scale.y, scale.z } do
    if P.check_number(x, subject .. ": scale") == 0 then fail("%s: scale must not be 0", subject) end
  end
  api.mesh_clear(ctx)
  if not from_file then
    if #source > 100000 then fail("%s takes up to 100000 points", subject) end
    for i, point in ipairs(source) do
      local p = P.check_vec3(point, subject .. ": point " .. i)
      api.mesh_point(ctx, P.check_number(p.x, subject), P.check_number(p.y, subject), P.check_number(p.z, subject))
    end
  end
  local file = from_file and source or ""
  P.handle_result(api.add_mesh_shape(ctx, name, #name, file, #file, scale.x, scale.y, scale.z, max_vertices,
    concave and 1 or 0))
  return P.answered_handle()
end)

-- surfaces
local function check_positive(value, subject)
  if P.check_number(value, subject) <= 0 then fail("%s must be above 0, not %s", subject, describe(value)) end
  return value
end
local function check_side(value, subject)
  P.check_number(value, subject)
  if value % 1 ~= 0 or value < 2 or value > 1024 then fail("%s is 2 .. 1024, not %s", subject, describe(value)) end
  return value
end

method("add_mesh_shape", function(_, name, file, opts)
  P.check_text(name, "add_mesh_shape: the name")
  P.check_text(file, "add_mesh_shape: the file's name")
  P.check_opts({ setters = {} }, opts, { scale = true }, "add_mesh_shape")
  local scale = opts and opts.scale or 1
  if type(scale) == "number" then scale = P.V(scale, scale, scale) end
  scale = P.check_vec3(scale, "add_mesh_shape: scale")
  for _, x in ipairs { scale.x, scale.y, scale.z } do
    if P.check_number(x, "add_mesh_shape: scale") == 0 then fail("add_mesh_shape: scale must not be 0") end
  end
  P.handle_result(api.add_mesh_surface(ctx, name, #name, file, #file, scale.x, scale.y, scale.z))
  return P.answered_handle()
end)

local heightfield_opts = { size = true, rows = true, columns = true, heights = true, image = true, height = true }
-- Fills an array with heights in rows from -y to +y, each from -x to +x.
local function heights_of(source, width, length, columns, rows)
  local subject = "add_heightfield_shape: height "
  local values = ffi.new("double[?]", rows * columns)
  if type(source) == "table" and #source ~= rows * columns then
    fail("add_heightfield_shape: %d rows and %d columns need %d heights, not %d", rows, columns, rows * columns, #source)
  elseif type(source) ~= "table" and type(source) ~= "function" then
    fail("add_heightfield_shape: heights is a list or a function(x, y), not %s", describe(source))
  end
  for row = 0, rows - 1 do
    for column = 0, columns - 1 do
      local i = row * columns + column
      local z
      if type(source) == "table" then
        z = source[i + 1]
      else
        z = source(width * (column / (columns - 1) - 0.5), length * (row / (rows - 1) - 0.5))
      end
      values[i] = P.check_number(z, subject .. (i + 1))
    end
  end
  return values
end
method("add_heightfield_shape", function(_, name, opts)
  local subject = "add_heightfield_shape"
  P.check_text(name, subject .. ": the name")
  if type(opts) ~= "table" then fail("%s takes a table such as { size = { 10, 10 }, … }, not %s", subject, describe(opts)) end
  P.check_opts({ setters = {} }, opts, heightfield_opts, subject)
  if type(opts.size) ~= "table" then fail("%s: size is { x, y } in meters, not %s", subject, describe(opts.size)) end
  local width = check_positive(opts.size[1], subject .. ": size x")
  local length = check_positive(opts.size[2], subject .. ": size y")
  if opts.image ~= nil then
    if opts.heights ~= nil or opts.rows ~= nil or opts.columns ~= nil then
      fail("%s: an image has rows, columns and heights of its own; remove one or the other", subject)
    end
    P.check_text(opts.image, subject .. ": image")
    local height = check_positive(opts.height, subject .. ": height (of white, m)")
    P.handle_result(api.add_heightfield_image(ctx, name, #name, width, length, opts.image, #opts.image, height))
    return P.answered_handle()
  end
  if opts.height ~= nil then fail("%s: height is that of white in an image; write image = \"…\", or remove it", subject) end
  local rows, columns = check_side(opts.rows, subject .. ": rows"), check_side(opts.columns, subject .. ": columns")
  local heights = heights_of(opts.heights, width, length, columns, rows)
  P.handle_result(api.add_heightfield(ctx, name, #name, width, length, columns, rows, heights))
  return P.answered_handle()
end)

-- model files: URDF and MJCF
local urdf_own = { name = true, fixed_base = true, keep_fixed = true, motors = true, pose = true, package_path = true, root = true,
  position = true, rotation = true }
local function flag(which, value, subject)
  if value == nil then return end
  if type(value) ~= "boolean" then fail("load_urdf: %s is true or false, not %s", subject, describe(value)) end
  api.urdf_flag(ctx, which, value and 1 or 0)
end
local function motor_option(motors)
  if motors == nil then return end
  if motors ~= "servo" and motors ~= "off" then
    fail("load_urdf: motors is 'servo' or 'off', not %s", describe(motors))
  end
  api.urdf_flag(ctx, 2, motors == "servo" and 1 or 0)
end
method("load_urdf", function(_, path, opts)
  P.check_text(path, "load_urdf: the file")
  P.check_opts(classes.body, opts, urdf_own, "load_urdf")
  opts = opts or {}
  api.urdf_clear(ctx)
  flag(0, opts.fixed_base, "fixed_base")
  flag(1, opts.keep_fixed, "keep_fixed")
  motor_option(opts.motors)
  if opts.pose ~= nil then
    if type(opts.pose) ~= "table" then
      fail("load_urdf: pose is a table { joint = value }, not %s", describe(opts.pose))
    end
    for _, joint in ipairs(P.sorted_keys(opts.pose)) do
      joint = P.check_text(joint, "load_urdf: pose, a joint's name")
      api.urdf_pose(ctx, joint, #joint, P.check_number(opts.pose[joint], "load_urdf: pose, " .. joint))
    end
  end
  local paths = opts.package_path
  for _, folder in ipairs(type(paths) == "table" and paths or { paths }) do
    P.check_text(folder, "load_urdf: package_path")
    api.urdf_package_path(ctx, folder, #folder)
  end
  if opts.root ~= nil then
    P.check_text(opts.root, "load_urdf: root")
    api.urdf_root(ctx, opts.root, #opts.root)
  end
  local name = opts.name == nil and "" or P.check_text(opts.name, "load_urdf: name")
  local code = api.load_urdf(ctx, path, #path, name, #name, P.pose_of(opts, "load_urdf", 0 / 0))
  return P.finish_creation(code, classes.body, opts, urdf_own)
end)

-- gears
local gear, gears = classes.gear, 7
P.derive_members(gear)
P.add_common_members(gear)
for which, name in pairs { [0] = "joint_a", "joint_b" } do
  gear.getters[name] = function(h)
    if api.related(ctx, h.slot_, h.generation_, which) ~= 0 then P.fail_removed(h) end
    return (P.answered_handle())
  end
end
P.finish_class(gear)

local gear_own = { name = true, offset = true }
local function check_joint(value, subject)
  local of = P.class_of(value)
  if not of or of.name ~= "joint" then
    fail("add_gear: %s is a joint, as body:joint(name), not %s", subject, describe(value))
  end
  P.slot_of(value)
  return value
end
local function free_gear_name(h, wanted)
  local name, count = wanted, 1
  while api.find(ctx, h.slot_, h.generation_, gears, name, #name) == 0 do
    count = count + 1
    name = wanted .. "_" .. count
  end
  return name
end
method("add_gear", function(h, joint_a, joint_b, ratio, opts)
  check_joint(joint_a, "joint_a")
  check_joint(joint_b, "joint_b")
  P.check_number(ratio, "add_gear: the ratio")
  P.check_opts(gear, opts, gear_own, "add_gear")
  opts = opts or {}
  local name = opts.name
  if name == nil then
    name = free_gear_name(h, P.names[joint_a] .. "_" .. P.names[joint_b])
  else
    P.check_text(name, "add_gear: name")
  end
  local offset = opts.offset == nil and 0 / 0 or P.check_number(opts.offset, "add_gear: offset")
  local code = api.add_gear(ctx, name, #name, joint_a.slot_, joint_a.generation_, joint_b.slot_, joint_b.generation_,
    ratio, offset)
  return P.finish_creation(code, gear, opts, gear_own, joint_a)
end)
method("gear", function(h, key) return P.find_in(h, gears, key) end)
class.getters.gears = function(h) return P.list_of(h, gears) end

method("state_hash", function(h)
  api.state_hash(ctx, h.slot_, h.generation_)
  return P.text()
end)
method("reset", function()
  P.needs_callback("sim:reset")
  api.request_reset(ctx)
end)
method("panic", function()
  P.needs_callback("sim:panic")
  api.request_panic(ctx)
end)

P.finish_class(class)
P.sim = P.handle_of(P.world_slot, P.world_generation)
