-- Properties of parts derived from a few numbers: center of mass, inertia. Computed here without an API call, with the
-- same operations as in C++ (Part::center), so that both give bit-identical results at any time.
local P = ...
local api, ctx, view, V, slot_of = P.api, P.ctx, P.view, P.V, P.slot_of
local mass_table = api.mass_table(ctx)

function P.add_mass_members(part)
  local properties = part.properties
  local position, rotation, mass = properties.position.offset, properties.rotation.offset, properties.mass.offset

  part.getters.center = function(h)
    local p, c = slot_of(h).transient + position, mass_table.list[mass_table.indices[h.slot_]]
    local q = p + (rotation - position)
    local values, x, y, z = view.transient, c.x, c.y, c.z
    local qx, qy, qz, w = values[q], values[q + 1], values[q + 2], values[q + 3]
    local ux, uy, uz = qy * z - y * qz, qz * x - z * qx, qx * y - x * qy
    return (V(values[p] + (x + (ux * w + (qy * uz - uy * qz)) * 2),
      values[p + 1] + (y + (uy * w + (qz * ux - uz * qx)) * 2),
      values[p + 2] + (z + (uz * w + (qx * uy - ux * qy)) * 2)))
  end

  part.getters.inertia = function(h)
    local m, c = view.persistent[slot_of(h).persistent + mass], mass_table.list[mass_table.indices[h.slot_]]
    return (V(c.inertia_x * m, c.inertia_y * m, c.inertia_z * m))
  end
end
