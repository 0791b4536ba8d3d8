// UrdfReader: reads and validates the elements and attributes of a URDF. Reports invalid values with their line, the
// value in the file, and a fix. Internal to the module: only src/model includes it.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tinyxml2.h>

#include "model/problems.h"
#include "model/urdf/file.h"

namespace limber::model {

/// The valid range of a number.
struct NumberRange {
  double min;
  double max;
  const char* description;  ///< Description for messages, such as "above 0, at most 10000 m".
};

inline constexpr NumberRange kLengthRange{1e-9, 1e4, "above 0, at most 10000 m"};
inline constexpr NumberRange kPositionRange{-1e4, 1e4, "within 10000 m"};
inline constexpr NumberRange kAngleRange{-1e6, 1e6, "within 1e6 rad"};

class UrdfReader {
 public:
  using Element = tinyxml2::XMLElement;

  /// `root_prefix`: "r:" when the file says <r:robot>, else empty.
  UrdfReader(Problems& problems, std::string root_prefix) : problems(problems), prefix_(std::move(root_prefix)) {}

  /// The element's name without the root's prefix.
  std::string_view name_of(const Element& element) const;
  const Element* child(const Element& parent, std::string_view name) const;
  /// Like child(), but warns if there are more than one; returns the first.
  const Element* unique_child(const Element& parent, std::string_view name, const std::string& owner);

  /// `owner` is "link 'a'" or "joint 'j'", for messages. Empty if the attribute is absent, or invalid (which is
  /// reported).
  std::optional<double> number(const Element& element, const char* attribute, const std::string& owner,
                               const NumberRange& range);
  std::optional<Vec3> vector(const Element& element, const char* attribute, const std::string& owner,
                             const NumberRange& range);
  /// The <origin> of an element; absent or invalid attributes are 0.
  UrdfOrigin origin(const Element& parent, const std::string& owner);

  /// Reads the <color rgba="…"> and <texture filename="…"> of a material; false if it has neither, or no valid one.
  bool material(const Element& material, const std::string& owner, UrdfMaterial& out);

  /// Reads a <link> with its shapes; `name` must be valid.
  UrdfLink link(const Element& element, const std::string& name);
  /// Reads a <joint>; empty if it names no parent or child link (which is reported).
  std::optional<UrdfJoint> joint(const Element& element, const std::string& name);

  /// Reads a <limber:loop>; empty if it names no two links (which is reported).
  std::optional<UrdfLoop> loop(const Element& element);

  /// Counts attributes of an element that are not in `known`; finish() reports them.
  void check_attributes(const Element& element, std::initializer_list<std::string_view> known);

  /// Reports, once for the whole file, numbers in unusual notation and (grouped) unknown attributes.
  void report_deferred();

  Problems& problems;

 private:
  struct UnusedAttribute {
    int count = 0;
    int line = 0;
    std::vector<std::string_view> known;
  };
  void report_attributes();
  std::optional<double> parse_in_range(std::string_view text, int line, const std::string& where,
                                       const NumberRange& range);
  bool numbers(const Element& element, const char* attribute, const std::string& owner, const NumberRange& range,
               std::span<double> out);
  std::optional<UrdfInertial> inertial(const Element& element, const std::string& owner);
  void tensor(const Element& element, const std::string& owner, UrdfInertial& out);
  std::optional<UrdfShape> shape(const Element& element, const std::string& owner);
  bool geometry(const Element& element, const std::string& owner, UrdfShape& out);
  bool mesh_geometry(const Element& element, const std::string& owner, UrdfShape& out);
  bool read_length(const Element& element, const char* attribute, const std::string& owner, double& out);
  JointType joint_type(const Element& element, const std::string& owner);
  Vec3 axis(const Element& element, const std::string& owner);
  bool loop_sides(const Element& element, const std::string& owner, UrdfLoop& out);
  void spherical(const Element& element, const std::string& owner, UrdfJoint& out);
  void ball_limits(const Element& limit, const std::string& owner, BallLimitsModel& out);
  void limit(const Element& element, const std::string& owner, UrdfJoint& out);
  void bounds(const Element& limit, const std::string& owner, UrdfJoint& out);
  std::optional<UrdfMimic> mimic(const Element& element, const std::string& owner);
  void dynamics(const Element& element, const std::string& owner, UrdfJoint& out);

  std::string prefix_;
  int nonstandard_numbers_ = 0;
  int nonstandard_line_ = 0;
  std::string nonstandard_text_;
  std::map<std::pair<std::string, std::string>, UnusedAttribute> unused_attributes_;  // by element and attribute
};

}  // namespace limber::model
