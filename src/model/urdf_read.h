// Reads attributes of URDF elements: numbers with reasons and ranges, vectors, names. What is wrong is said with the
// line, what the file says, and the cure. Part of the room's inside: only src/model includes it.
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
#include "model/urdf_file.h"

namespace limber {

/// What a number may be.
struct NumberRange {
  double lowest;
  double highest;
  const char* text;  ///< "above 0, at most 10000 m", as the complaint says it.
};

inline constexpr NumberRange kLengthRange{1e-9, 1e4, "above 0, at most 10000 m"};
inline constexpr NumberRange kPlaceRange{-1e4, 1e4, "within 10000 m"};
inline constexpr NumberRange kAngleRange{-1e6, 1e6, "within 1e6 rad"};

class UrdfReader {
 public:
  using Element = tinyxml2::XMLElement;

  /// `root_prefix`: "r:" when the file says <r:robot>, else empty.
  UrdfReader(Problems& problems, std::string root_prefix) : problems(problems), prefix_(std::move(root_prefix)) {}

  /// The element's name without the root's prefix.
  std::string_view name_of(const Element& element) const;
  const Element* child(const Element& parent, std::string_view name) const;
  /// The same, and says when there are more of it: the first counts.
  const Element* only_child(const Element& parent, std::string_view name, const std::string& owner);

  /// `owner` is "link 'a'" or "joint 'j'". Nothing when the attribute is absent (silent) or wrong (said).
  std::optional<double> number(const Element& element, const char* attribute, const std::string& owner,
                               const NumberRange& range);
  std::optional<Vec3> vector(const Element& element, const char* attribute, const std::string& owner,
                             const NumberRange& range);
  /// The <origin> of an element; what is wrong or absent stays 0.
  UrdfOrigin origin(const Element& parent, const std::string& owner);

  /// Colour and alpha of a <color rgba="…">.
  bool color(const Element& material, const std::string& owner, std::optional<Vec3>& color, double& alpha);

  /// One link element with its shapes; the name was checked.
  UrdfLink link(const Element& element, const std::string& name);
  /// One joint element; nothing when it can't connect anything (said).
  std::optional<UrdfJoint> joint(const Element& element, const std::string& name);

  /// Counts attributes of an element that are not among `known`, to be reported by finish().
  void check_attributes(const Element& element, std::initializer_list<std::string_view> known);

  /// Reports once, at the end, numbers that were read but are spelled oddly, and, grouped, attributes without effect.
  void finish();

  Problems& problems;

 private:
  struct UnusedAttribute {
    int count = 0;
    int line = 0;
    std::vector<std::string_view> known;
  };
  void report_attributes();
  void check_concave(const Element& element, const std::string& owner);
  std::optional<double> one_number(std::string_view text, int line, const std::string& where, const NumberRange& range);
  bool numbers(const Element& element, const char* attribute, const std::string& owner, const NumberRange& range,
               std::span<double> out);
  std::optional<UrdfInertial> inertial(const Element& element, const std::string& owner);
  void tensor(const Element& element, const std::string& owner, UrdfInertial& out);
  std::optional<UrdfShape> shape(const Element& element, const std::string& owner);
  bool geometry(const Element& element, const std::string& owner, UrdfShape& out);
  bool mesh_geometry(const Element& element, const std::string& owner, UrdfShape& out);
  bool positive(const Element& element, const char* attribute, const std::string& owner, double& out);
  JointType joint_type(const Element& element, const std::string& owner);
  Vec3 axis(const Element& element, const std::string& owner);
  void limit(const Element& element, const std::string& owner, UrdfJoint& out);
  void bounds(const Element& limit, const std::string& owner, UrdfJoint& out);
  std::optional<UrdfMimic> mimic(const Element& element, const std::string& owner);

  std::string prefix_;
  int odd_numbers_ = 0;
  int odd_line_ = 0;
  std::string odd_text_;
  std::map<std::pair<std::string, std::string>, UnusedAttribute> unused_attributes_;  // by element and attribute
  int concave_meshes_ = 0;
  int concave_line_ = 0;
  std::string concave_owner_;
};

}  // namespace limber
