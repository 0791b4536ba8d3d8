// MjcfHeightfields: the <hfield> assets of an MJCF file. Internal to the module: only src/model includes it.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "base/result.h"
#include "model/mjcf/document.h"
#include "model/mjcf/file.h"
#include "model/mjcf/reader.h"

namespace limber::model {

class MjcfHeightfields {
 public:
  std::size_t size() const { return assets_.size(); }
  /// Reads an element of <asset>; reports one that is invalid.
  void read(MjcfReader& reader, const MjcfElement& element);
  /// Makes a geom the heightfield with this name (null: it names none). False: there is none, which is reported.
  bool apply(MjcfReader& reader, const MjcfElement& element, const std::string* name, MjcfGeom& geom) const;

 private:
  struct Asset {
    ShapeModel shape;    // of heights in the file
    std::string uri;     // of the image; empty: `shape`
    Vec3 size{1, 1, 1};  // width, length, height
  };
  static Result<Asset> read_asset(MjcfReader& reader, const MjcfElement& element);

  std::map<std::string, Asset, std::less<>> assets_;
};

}  // namespace limber::model
