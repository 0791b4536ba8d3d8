// Heightfield: a mesh with one vertex for each point of the grid.
#include "model/mesh/heightfield.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "model/mesh/surface.h"

namespace limber::model {

namespace {

constexpr double kMinSize = 1e-3;
constexpr double kMaxSize = 1e4;

Result<void> check(const Heightfield& field) {
  for (const int side : {field.columns, field.rows}) {
    if (side >= kMinHeightfieldSide && side <= kMaxHeightfieldSide) continue;
    return Error{fmt::format("a heightfield has {} .. {} rows and columns, not {}", kMinHeightfieldSide,
                             kMaxHeightfieldSide, side)};
  }
  for (const double size : {field.width, field.length}) {
    if (size >= kMinSize && size <= kMaxSize) continue;
    return Error{fmt::format("a heightfield needs a size of {} .. {} m, not {}", kMinSize, kMaxSize, size)};
  }
  const std::size_t count = static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows);
  if (field.heights.size() != count) {
    return Error{fmt::format("a heightfield of {} rows and {} columns needs {} heights, not {}", field.rows,
                             field.columns, count, field.heights.size())};
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(field.heights[i]) <= kMaxSize) continue;
    return Error{fmt::format("height {} (row {}, column {}) is {}; heights are -{} .. {} m", i + 1,
                             i / static_cast<std::size_t>(field.columns) + 1,
                             i % static_cast<std::size_t>(field.columns) + 1, field.heights[i], kMaxSize, kMaxSize)};
  }
  return {};
}

}  // namespace

Result<ShapeModel> heightfield_shape(const Heightfield& field, const std::string& name) {
  if (const Result<void> valid = check(field); !valid) return Error{valid.error()};
  auto mesh = std::make_shared<MeshModel>();
  mesh->name = name;
  mesh->vertices.reserve(field.heights.size());
  const auto columns = static_cast<unsigned>(field.columns);
  const auto rows = static_cast<unsigned>(field.rows);
  for (unsigned row = 0; row < rows; ++row) {
    const double y = field.length * (row / (rows - 1.0) - 0.5);
    for (unsigned column = 0; column < columns; ++column) {
      const double x = field.width * (column / (columns - 1.0) - 0.5);
      mesh->vertices.emplace_back(x, y, field.heights[std::size_t{row} * columns + column]);
    }
  }
  mesh->triangles.reserve(std::size_t{6} * (rows - 1) * (columns - 1));
  for (unsigned row = 0; row + 1 < rows; ++row) {
    for (unsigned column = 0; column + 1 < columns; ++column) {
      const unsigned a = row * columns + column;
      for (const unsigned corner : {a, a + 1, a + columns + 1, a, a + columns + 1, a + columns})
        mesh->triangles.push_back(corner);
    }
  }
  const std::string_view bytes(reinterpret_cast<const char*>(mesh->vertices.data()),
                               mesh->vertices.size() * sizeof(Vec3));
  mesh->content_hash = hash_bytes(bytes, columns);
  return surface_shape(std::move(mesh));
}

std::vector<double> heights_of(const Image& image) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::vector<double> out;
  out.reserve(width * height);
  for (std::size_t row = height; row-- > 0;) {
    for (std::size_t column = 0; column < width; ++column) {
      const std::uint8_t* const pixel = &image.pixels[4 * (row * width + column)];
      out.push_back((pixel[0] + pixel[1] + pixel[2]) / (3 * 255.0));
    }
  }
  return out;
}

std::vector<double> normalized_heights(std::vector<double> heights, double height) {
  if (heights.empty()) return heights;
  const auto [low, high] = std::ranges::minmax(heights);
  for (double& each : heights) each = high > low ? (each - low) / (high - low) * height : 0;
  return heights;
}

}  // namespace limber::model
