-- Fast path for forces and torques of one vec3, which most behaviors use: written into a queue without an API call. All
-- other cases use the general action method.
local P = ...
local api, ctx, answer, view, istype = P.api, P.ctx, P.answer, P.view, P.ffi.istype
local V, part = P.V, P.classes.part
local ctype = part.ctype
local queue = api.forces(ctx)

local function add_fast_path(name, is_torque)
  local general = part.methods[name]
  part.methods[name] = function(h, v, at)
    if not (at == nil and istype(ctype, h) and istype(V, v)) or answer.top_level ~= 0 then return general(h, v, at) end
    local slot, x, y, z = h.slot_, v.x, v.y, v.z
    -- removed parts and non-finite values are reported by the general method
    if not (slot >= 0 and slot < view.slot_count) or view.slots[slot].generation ~= h.generation_ or
      x - x ~= 0 or y - y ~= 0 or z - z ~= 0 then
      return general(h, v)
    end
    local n = queue.count
    if n >= queue.capacity then
      api.forces_full(ctx)
      n = queue.count
    end
    local f = queue.list[n]
    f.x, f.y, f.z, f.slot, f.is_torque = x, y, z, slot, is_torque
    queue.count = n + 1
  end
end

add_fast_path("apply_force", 0)
add_fast_path("apply_torque", 1)
