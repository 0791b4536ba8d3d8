// The attributes of MJCF elements: which are used, which are valid but have no effect, and which are misspelled.
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "model/mjcf/reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

struct ElementAttributes {
  std::string_view element;
  std::string_view used;     ///< Names with blanks between them.
  std::string_view ignored;  ///< Valid in MuJoCo, without effect here.
};

constexpr std::string_view kActuatorUsed =
    "name class joint jointinparent tendon gear kp kv ctrllimited ctrlrange forcelimited forcerange gainprm biastype "
    "biasprm "
    "gaintype";
constexpr std::string_view kActuatorIgnored =
    "group lengthrange actlimited actrange user site refsite body cranklength cranksite slidersite dyntype "
    "dynprm "
    "actdim actearly dampratio timeconst inheritrange timelimit plugin area diameter bias lmin lmax vmax fpmax "
    "fvmax force scale range gain nsample interp delay";

constexpr std::string_view kSensorIgnored = "cutoff noise user nsample interp delay interval data";

constexpr std::array<ElementAttributes, 29> kElements{{
    {"compiler",
     "angle eulerseq meshdir assetdir autolimits coordinate inertiafromgeom inertiagrouprange boundmass boundinertia "
     "balanceinertia settotalmass strippath texturedir",
     "discardvisual usethread fusestatic exactmeshinertia convexhull fitaabb alignfree saveinertial"},
    {"body", "name childclass pos quat axisangle euler xyaxes zaxis mocap", "user gravcomp sleep"},
    {"frame", "name childclass pos quat axisangle euler xyaxes zaxis", ""},
    {"inertial", "pos quat axisangle euler xyaxes zaxis mass diaginertia fullinertia", ""},
    {"freejoint", "name", "group align"},
    {"joint",
     "name class type pos axis limited range ref damping frictionloss actuatorfrcrange actuatorfrclimited "
     "springref springdamper stiffness armature",
     "group margin user solreflimit solimplimit solreffriction solimpfriction actuatorgravcomp"},
    {"geom",
     "name class type pos quat axisangle euler xyaxes zaxis fromto size mass density contype conaffinity group rgba "
     "material mesh hfield",
     "condim priority friction solmix solref solimp margin gap user shellinertia fitscale fluidshape fluidcoef"},
    {"site", "name class pos quat axisangle euler xyaxes zaxis fromto size", "type group material rgba user"},
    {"mesh", "name class file scale refpos refquat vertex face",
     "normal texcoord smoothnormal maxhullvert inertia "
     "content_type builtin params material"},
    {"hfield", "name file nrow ncol size elevation", "content_type"},
    {"material", "name class rgba texture",
     "texrepeat texuniform emission specular shininess reflectance metallic "
     "roughness"},
    {"exclude", "name class body1 body2", ""},
    {"connect", "name class active body1 body2 anchor site1 site2", "solref solimp"},
    {"weld", "name class active body1 body2 anchor relpose site1 site2", "solref solimp torquescale"},
    {"equality of joints", "name class active joint1 joint2 tendon1 tendon2 polycoef", "solref solimp"},
    {"fixed", "name class limited range stiffness damping frictionloss",
     "group springlength solreflimit solimplimit solreffriction solimpfriction margin width material rgba user "
     "armature actuatorfrclimited actuatorfrcrange"},
    {"joint of a tendon", "joint coef", ""},
    {"spatial", "name class limited range stiffness damping frictionloss springlength width",
     "group solreflimit solimplimit solreffriction solimpfriction margin material rgba user armature "
     "actuatorfrclimited actuatorfrcrange"},
    {"site of a tendon", "site", ""},
    {"general", kActuatorUsed, kActuatorIgnored},
    {"motor", kActuatorUsed, kActuatorIgnored},
    {"position", kActuatorUsed, kActuatorIgnored},
    {"velocity", kActuatorUsed, kActuatorIgnored},
    {"intvelocity", kActuatorUsed, kActuatorIgnored},
    {"damper", kActuatorUsed, kActuatorIgnored},
    {"accelerometer", "name site", kSensorIgnored},
    {"gyro", "name site", kSensorIgnored},
    {"rangefinder", "name site cutoff", kSensorIgnored},
    {"touch", "name site", kSensorIgnored},
}};

bool lists(std::string_view names, std::string_view name) {
  for (std::size_t at = names.find(name); at != std::string_view::npos; at = names.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || names[at - 1] == ' ') && (end == names.size() || names[end] == ' ')) return true;
  }
  return false;
}

const char* fix_of(const std::set<std::string>& attributes) {
  if (attributes.contains("friction")) return "Set the friction of parts in the scene: part.friction.";
  if (attributes.contains("gravcomp")) return "Set forces in the scene.";
  return "Nothing to do, unless you expected an effect.";
}

}  // namespace

void MjcfReader::check_attributes(const MjcfElement& element, std::string_view kind) {
  const auto known =
      std::find_if(kElements.begin(), kElements.end(), [&](const ElementAttributes& e) { return e.element == kind; });
  if (known == kElements.end()) return;
  for (const auto& [attribute, value] : element.attributes) {
    if (lists(known->used, attribute)) continue;
    if (lists(known->ignored, attribute)) {
      Ignored& entry = ignored_[element.name];
      if (entry.count++ == 0) entry.first = &element;
      entry.attributes.insert(attribute);
      continue;
    }
    const std::string text =
        fmt::format("<{}> has no attribute '{}'; ignored", element.name, printable_excerpt(attribute));
    if (count_unsupported(text)) continue;
    std::vector<std::string_view> names = split(known->used, ' ');
    for (const std::string_view name : split(known->ignored, ' ')) names.push_back(name);
    const std::string_view suggestion = nearest_name(attribute, names);
    unsupported(element, text,
                suggestion.empty() ? "Remove it, or correct its name." : fmt::format("Did you mean '{}'?", suggestion),
                Severity::warning);
  }
}

void MjcfReader::report_ignored() {
  for (const auto& [element, entry] : ignored_) {
    note(*entry.first,
         fmt::format("<{}>: {} {} no effect", element, fmt::join(entry.attributes, ", "),
                     entry.attributes.size() == 1 ? "has" : "have"),
         fix_of(entry.attributes));
  }
  ignored_.clear();
}

}  // namespace limber::model
