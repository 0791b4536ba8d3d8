-- What of a part follows from a few of its numbers: centre of mass, inertia. Worked out here, without a call, step by step
-- as C++ does it (Part::center): both have the same bits, at any moment of a call.
local P = ...
local api, ctx, view, V, slot_of = P.api, P.ctx, P.view, P.V, P.slot_of
local solids = api.solids(ctx)

function P.solid_members(part)
  local rows = part.rows
  local position, rotation, mass = rows.position.offset, rows.rotation.offset, rows.mass.offset

  part.getters.center = function(h)
    local p, c = slot_of(h).live + position, solids.list[solids.places[h.slot_]]
    local q = p + (rotation - position)
    local live, x, y, z = view.live, c.x, c.y, c.z
    local qx, qy, qz, w = live[q], live[q + 1], live[q + 2], live[q + 3]
    local ux, uy, uz = qy * z - y * qz, qz * x - z * qx, qx * y - x * qy
    return (V(live[p] + (x + (ux * w + (qy * uz - uy * qz)) * 2), live[p + 1] + (y + (uy * w + (qz * ux - uz * qx)) * 2),
      live[p + 2] + (z + (uz * w + (qx * uy - ux * qy)) * 2)))
  end

  part.getters.inertia = function(h)
    local m, c = view.kept[slot_of(h).kept + mass], solids.list[solids.places[h.slot_]]
    return (V(c.inertia_x * m, c.inertia_y * m, c.inertia_z * m))
  end
end
