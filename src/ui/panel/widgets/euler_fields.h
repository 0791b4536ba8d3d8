// A rotation as Euler angles, below its quaternion.
#pragma once

#include "base/vec.h"
#include "ui/panel/gui_context.h"

namespace limber::panel {

/// The angles in degrees about the fixed axes x, then y, then z, as those of quat.euler() in Lua and of URDF: -180 ..
/// 180, y -90 .. 90. At y = ±90, where only the sum or difference of x and z is determined, z is 0.
Vec3 degrees_of(const double* quaternion);
/// The inverse of degrees_of(); writes x y z w.
void put_degrees(const Vec3& degrees, double* quaternion);

/// The height in pixels of euler_fields().
float euler_height(const GuiContext& context, float width);

/// Draws a line with the name of the angles and a row of fields, which set the rotation if the property is writable.
/// They are named "euler:" and the address, with /0, /1, /2. Values that are changed are sent.
void euler_fields(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width);

}  // namespace limber::panel
