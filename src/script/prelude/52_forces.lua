-- Forces and torques of one vec3, what most behaviours are made of: written into a queue without a call. Everything else
-- that may be pushed goes the way of all actions.
local P = ...
local api, ctx, answer, view, istype = P.api, P.ctx, P.answer, P.view, P.ffi.istype
local V, part = P.V, P.classes.part
local ctype = part.ctype
local queue = api.forces(ctx)

local function pushing(name, turns)
  local general = part.methods[name]
  part.methods[name] = function(h, v, at)
    if not (at == nil and istype(ctype, h) and istype(V, v)) or answer.top_level ~= 0 then return general(h, v, at) end
    local slot, x, y, z = h.slot_, v.x, v.y, v.z
    -- alive, and finite: what is not is explained by the general way
    if not (slot >= 0 and slot < view.slot_count) or view.slots[slot].generation ~= h.generation_ or
      x - x ~= 0 or y - y ~= 0 or z - z ~= 0 then
      return general(h, v)
    end
    local n = queue.count
    if n >= queue.room then
      api.forces_full(ctx)
      n = queue.count
    end
    local f = queue.list[n]
    f.x, f.y, f.z, f.slot, f.turns = x, y, z, slot, turns
    queue.count = n + 1
  end
end

pushing("apply_force", 0)
pushing("apply_torque", 1)
