-- Sensors of parts, contacts, rays.

---@page sensors

---Returns the contact points of the last tick of a part with `report_contacts`.
---@return contact_point[]
---@see part.report_contacts, part.contact_force, sim:on_contact
---@example contact_points
function part_:contacts() end

---A contact point of a part.
---@class contact_point
---@field part part # The part that it touches.
---@field position vec3 # Its place in m, world.
---@field normal vec3 # Direction in which the other part pushes this one, world, unit length.
---@field friction vec3 # Friction force on this part in N, world, mean of the tick.
---@field force number # Normal force in N, mean of the tick.
---@field impulse number # Normal impulse of the tick in N·s.
---@field distance number # Distance of the surfaces in m; negative: penetration.
---@see part:contacts
---@example contact_points

---Adds an accelerometer and gyroscope. Without options it is at the origin of the part's link frame.
---@param name string # A name of your choice, unique among the sensors of the body.
---@param opts? imu_opts # Such as `position`, in the link frame.
---@return imu
---@error body:part(1):add_imu(3) --> add_imu: the name takes text, not 3
---@see imu, body:sensor
---@example imu
function part_:add_imu(name, opts) end

---Adds a range finder, which measures the distance along a ray.
---@param name string # A name of your choice, unique among the sensors of the body.
---@param opts? range_finder_opts # Such as `direction`, in the link frame.
---@return range_finder
---@error body:part(1):add_range_finder("eye", { direction = vec3(0, 0, 0) }) --> /physics/body/body/sensor/eye/direction: the direction of a range finder must not be zero
---@see range_finder, sim:ray
---@example range_finder
function part_:add_range_finder(name, opts) end

---Adds a proximity zone: a sphere that reports the parts in it. A zone of a static part stays where it is.
---@param name string # A name of your choice, unique among the sensors of the body.
---@param opts? zone_opts # Such as `radius`.
---@return zone
---@see zone, sim:on_zone_enter
---@example zone
function part_:add_zone(name, opts) end

---Adds a touch sensor, and sets `report_contacts` of the part.
---@param name string # A name of your choice, unique among the sensors of the body.
---@param opts? touch_opts # Such as `position` and `radius` of its region.
---@return touch
---@see touch, part:contacts
---@example touch
function part_:add_touch(name, opts) end

---Returns a sensor by name or number (-1: the last).
---@param key string|integer|imu|range_finder|zone|touch # Its name, its number from 1, or -1 for the last.
---@return imu|range_finder|zone|touch
---@error body:sensor("eye") --> body 'body' has no sensor 'eye'; none exist
---@see body.sensors
---@example imu
function body_:sensor(key) end

---An accelerometer and gyroscope of a part.
---@class imu
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field part part # read-only. The part that it is mounted on.
---@properties imu
---@see part:add_imu
---@example imu

---@class imu_opts
---@opts imu

---Measures the distance to the nearest part along a ray.
---@class range_finder
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field part part # read-only. The part that it is mounted on.
---@field other? part # read-only. The part that it sees, or nil.
---@properties range_finder
---@see part:add_range_finder
---@example range_finder

---@class range_finder_opts
---@opts range_finder

---A sphere around a place on a part, which reports the parts in it.
---@class zone
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field part part # read-only. The part that it is mounted on.
---@field other? part # read-only. The nearest part in it, or nil.
---@properties zone
---@see part:add_zone
---@example zone

---@class zone_opts
---@opts zone

---Measures the normal force of contacts in a region of a part.
---@class touch
---@field name string # read-only. Its name.
---@field alive boolean # read-only. True while it exists.
---@field body body # read-only. The body that it belongs to.
---@field part part # read-only. The part that it is mounted on.
---@properties touch
---@see part:add_touch
---@example touch

---@class touch_opts
---@opts touch

---@page lists

---The sensors of a body.
---@class sensor_list
---@field [integer] imu|range_finder|zone|touch
---@overload fun(self: body, wanted?: string|imu|range_finder|zone|touch): fun(): imu|range_finder|zone|touch, integer
---@see body.sensors
---@example lists
