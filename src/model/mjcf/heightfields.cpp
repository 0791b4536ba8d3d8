// Heightfields of MJCF files: from numbers, or from an image that is read later.
#include "model/mjcf/heightfields.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/heightfield.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

void MjcfHeightfields::read(MjcfReader& reader, const MjcfElement& element) {
  reader.check_attributes(element);
  std::string name = reader.name(element);
  if (const std::string* const file = element.attribute("file"); file != nullptr && name.empty())
    name = std::filesystem::path(*file).stem().string();
  Result<Asset> asset = read_asset(reader, element);
  if (!asset) {
    reader.error(
        element, fmt::format("{} ignored: {}", reader.shown(element), asset.error()),
        "Write size=\"half_x half_y height base\" in meters, and file=\"….png\", or nrow, ncol and elevation.");
    return;
  }
  assets_.try_emplace(name, std::move(*asset));
}

// The first line of numbers, and of pixels, is the far one (+y).
Result<MjcfHeightfields::Asset> MjcfHeightfields::read_asset(MjcfReader& reader, const MjcfElement& element) {
  const std::vector<double> size = reader.numbers(element, 0, "size", 4, 4);
  if (size.size() != 4) return Error{"it has no size"};
  Asset asset;
  asset.size = {2 * size[0], 2 * size[1], size[2]};
  if (const std::string* const file = element.attribute("file")) {
    asset.uri = mjcf_asset_path(reader.compiler, reader.compiler.mesh_folder, *file);
    return asset;
  }
  const double rows = reader.number(element, 0, "nrow", 0);
  const double columns = reader.number(element, 0, "ncol", 0);
  for (const double side : {rows, columns}) {
    if (side >= kMinHeightfieldSide && side <= kMaxHeightfieldSide) continue;
    return Error{fmt::format("nrow and ncol are {} .. {}", kMinHeightfieldSide, kMaxHeightfieldSide)};
  }
  const auto row_count = static_cast<std::size_t>(rows);
  const auto column_count = static_cast<std::size_t>(columns);
  const std::size_t count = row_count * column_count;
  const std::vector<double> written = reader.numbers(element, 0, "elevation", count, count);
  std::vector<double> heights(count, 0.0);
  if (written.size() == count) {
    for (std::size_t row = 0; row < row_count; ++row)
      std::copy_n(written.begin() + static_cast<std::ptrdiff_t>((row_count - 1 - row) * column_count), column_count,
                  heights.begin() + static_cast<std::ptrdiff_t>(row * column_count));
  }
  heights = normalized_heights(std::move(heights), size[2]);
  Result<ShapeModel> shape = heightfield_shape(
      {static_cast<int>(column_count), static_cast<int>(row_count), asset.size.x, asset.size.y, heights},
      reader.name(element));
  if (!shape) return Error{shape.error()};
  asset.shape = std::move(*shape);
  return asset;
}

bool MjcfHeightfields::apply(MjcfReader& reader, const MjcfElement& element, const std::string* name,
                             MjcfGeom& geom) const {
  const auto found = name == nullptr ? assets_.end() : assets_.find(*name);
  if (found == assets_.end()) {
    reader.error(element,
                 name == nullptr ? fmt::format("{} names no hfield; ignored", reader.shown(element))
                                 : fmt::format("{}: hfield '{}' does not exist, or is invalid; ignored",
                                               reader.shown(element), printable_excerpt(*name)),
                 "Write the name of an <hfield> in <asset>.");
    return false;
  }
  geom.shape.shape = found->second.shape;
  geom.shape.heights_uri = found->second.uri;
  geom.shape.mesh_scale = found->second.size;
  return true;
}

}  // namespace limber::model
