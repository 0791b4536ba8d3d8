// Heightfields: terrain from heights on a grid.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "model/body_model.h"
#include "model/look/image.h"

namespace limber::model {

inline constexpr int kMinHeightfieldSide = 2;
inline constexpr int kMaxHeightfieldSide = 1024;

/// Heights (m) above the points of a grid, centered on the origin: rows from -y to +y, each from -x to +x.
struct Heightfield {
  int columns = 0;    ///< Points along x.
  int rows = 0;       ///< Points along y.
  double width = 0;   ///< Of the grid along x, m.
  double length = 0;  ///< Along y, m.
  std::span<const double> heights;
};

/// The shape of a heightfield, which collides with its triangles: two per cell, divided from its lowest to its highest
/// corner in x and y. Errors describe the fault and the valid range. [any]
Result<ShapeModel> heightfield_shape(const Heightfield& field, const std::string& name);

/// The brightness of the pixels, 0 .. 1, in the order of Heightfield: the image is a map with +y up. [any]
std::vector<double> heights_of(const Image& image);

/// Heights stretched to 0 .. `height`, as MJCF does; equal ones become 0. [any]
std::vector<double> normalized_heights(std::vector<double> heights, double height);

}  // namespace limber::model
