// Conversion between joint types and their names.
#include "model/body_model.h"

#include <array>

#include "base/text.h"

namespace limber::model {

namespace {
constexpr std::array<std::string_view, 7> kTypes = {"fixed",  "revolute", "continuous", "prismatic",
                                                    "planar", "floating", "spherical"};
}  // namespace

std::string_view joint_type_name(JointType type) { return kTypes[static_cast<std::size_t>(type)]; }

std::optional<JointType> joint_type_named(std::string_view name) {
  for (std::size_t i = 0; i < kTypes.size(); i++) {
    if (same_name(kTypes[i], name)) return static_cast<JointType>(i);
  }
  return {};
}

}  // namespace limber::model
