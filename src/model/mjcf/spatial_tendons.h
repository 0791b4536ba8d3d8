// SpatialTendons: reads <spatial> tendons, and the actuators that drive them. Internal to the module: only src/model
// includes it.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/mjcf/document.h"
#include "model/mjcf/file.h"
#include "model/mjcf/reader.h"

namespace limber::model {

class SpatialTendons {
 public:
  SpatialTendons(MjcfReader& reader, std::vector<MjcfTendon>& tendons) : reader_(reader), tendons_(tendons) {}

  /// Finds the site that an element names, as a point on a body; reports an unknown one.
  using FindSite = std::function<std::optional<TendonModel::Point>(const MjcfElement&)>;
  /// Reads a tendon; without two sites it is reported and ignored.
  void read(const MjcfElement& element, const FindSite& find_site);
  /// Applies an actuator to the tendon of this name; false if there is none.
  bool drive(const MjcfElement& element, std::string_view tendon);

 private:
  void read_path(const MjcfElement& element, const FindSite& find_site, TendonModel& tendon);
  void read_spring(const MjcfElement& element, MjcfClass cls, TendonModel& tendon);
  void read_length(const MjcfElement& element, MjcfClass cls, TendonModel& tendon);
  void read_range(const MjcfElement& element, MjcfClass cls, TendonModel& tendon);

  MjcfReader& reader_;
  std::vector<MjcfTendon>& tendons_;
  std::map<std::string, std::size_t, std::less<>> index_;  // in tendons_
};

}  // namespace limber::model
