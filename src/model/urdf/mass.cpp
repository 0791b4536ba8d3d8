// Masses of the body's links: from the file, or estimated from the shapes; replaces physically impossible tensors.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/mesh/mass_properties.h"
#include "model/urdf/build.h"

namespace limber::model {

namespace {

constexpr double kDensity = 1000;            // kg/m³, of water
constexpr double kMinEstimatedMass = 0.001;  // kg, minimum for links without a mass in the file
constexpr double kMinDeclaredMass = 1e-6;    // kg, minimum for links with a mass in the file

/// Mass properties of the collision shapes, or of the visual shapes if there are none, at density 1.
Inertial shapes_inertial(const std::vector<PlacedShape>& collisions, const std::vector<PlacedShape>& visuals) {
  std::vector<Inertial> solids;
  for (const PlacedShape& s : collisions.empty() ? visuals : collisions) {
    // a mesh that collides as a primitive still uses its own volume
    const bool recognized = s.shape.mesh && s.shape.kind != ShapeKind::mesh;
    if (recognized) {
      solids.push_back(transformed(s.shape.mesh->unit_inertial, s.origin * s.shape.mesh_pose));
    } else {
      solids.push_back(transformed(unit_inertial_of(s.shape), s.origin));
    }
  }
  return combined(solids);
}

Inertial shapes_inertial(const UrdfLink& link) {
  std::vector<Inertial> solids;
  for (const UrdfShape& s : link.collisions.empty() ? link.visuals : link.collisions) {
    solids.push_back(transformed(unit_inertial_of(s.shape), s.origin.pose()));
  }
  return combined(solids);
}

/// Fallback tensor for links without a usable shape: a sphere of water of this mass.
Mat3 sphere_tensor(double mass) {
  const double radius = fixed::cbrt(mass / kDensity * 3 / (4 * kPi));
  return Mat3(0.4 * mass * radius * radius);
}

Inertial estimated_inertial(Inertial shapes) {
  Inertial out = scaled(shapes, kDensity);
  if (out.mass >= kMinEstimatedMass) return out;
  return shapes.mass > 0 ? scaled(shapes, kMinEstimatedMass / shapes.mass)
                         : Inertial{kMinEstimatedMass, Vec3(0), sphere_tensor(kMinEstimatedMass)};
}

/// The inertial of a link with a mass in the file, in the link's frame; a missing or impossible tensor is replaced.
Inertial declared_inertial(UrdfBuildContext& build, const UrdfLink& link) {
  const UrdfInertial& from = *link.inertial;
  Inertial out = transformed({from.mass, Vec3(0), from.tensor}, from.origin.pose());
  if (out.mass < kMinDeclaredMass) {
    build.problems.warning(link.line,
                           fmt::format("link '{}': its mass of {:g} kg is too small; using {:g} kg",
                                       printable(link.name), out.mass, kMinDeclaredMass),
                           "Write a mass of at least some grams.");
    out = scaled(out, kMinDeclaredMass / out.mass);
  }
  const std::string fault = from.has_tensor ? tensor_error(out.tensor) : "there is none";
  if (fault.empty()) return out;
  const Inertial shapes = shapes_inertial(link);
  const bool usable = shapes.mass > 0 && tensor_error(shapes.tensor).empty();
  out.tensor = usable ? shapes.tensor * (out.mass / shapes.mass) : sphere_tensor(out.mass);
  if (from.has_tensor) {
    build.problems.warning(
        link.line,
        fmt::format("link '{}': its inertia tensor is impossible ({}); using {}", printable(link.name), fault,
                    usable ? "its shape's" : "that of a sphere of its mass"),
        "Write the tensor about the center of mass, in kg·m².");
  }
  return out;
}

// Removes planes and heightfields from a link that moves.
void drop_ground(UrdfBuildContext& build, LinkModel& link, int line) {
  const auto found = std::ranges::find_if(link.collisions, [](const PlacedShape& s) { return is_ground(s.shape); });
  if (found == link.collisions.end()) return;
  const bool is_plane = found->shape.kind == ShapeKind::plane;
  std::erase_if(link.collisions, [](const PlacedShape& s) { return is_ground(s.shape); });
  build.problems.error(
      line,
      fmt::format("link '{}' moves; its {} collision shape is ignored", printable(link.name),
                  is_plane ? "<plane>" : "heightfield"),
      fmt::format("Use a box, or attach the {} to the fixed root.", is_plane ? "plane" : "heightfield"));
}

void report_root(UrdfBuildContext& build, const UrdfLink& root, bool has_mass, double merged_mass) {
  const std::string name = printable(root.name);
  if (build.file.fixed_root) return;  // the file says so
  if (!build.options.fixed_base.has_value() && !has_mass) {
    const std::string also =
        merged_mass > 0 ? fmt::format(", with the {:.4g} kg that are fixed to it", merged_mass) : "";
    build.problems.note(root.line, fmt::format("root link '{}' has no mass; it is fixed to the world{}", name, also),
                        "Give it an <inertial>, or load with fixed_base = false, to let it move.");
  }
}

class MassBuilder {
 public:
  explicit MassBuilder(UrdfBuildContext& build) : build_(build) {
    parts_.resize(build.model.links.size());
    lines_.resize(build.model.links.size());
    connectors_.resize(build.model.links.size(), false);
    for (std::size_t node = 0; node < build.tree.size(); ++node) {
      const auto at = static_cast<std::size_t>(build.body_link[node]);
      const UrdfLink& link = build.link(node);
      if (lines_[at] == 0) lines_[at] = link.line;
      if (link.connector) connectors_[at] = true;
      const bool merged = node > 0 && build.body_joint[node] < 0;
      if (merged && is_marker(link)) {
        if (markers_++ == 0) first_marker_ = node;
      } else if (link.inertial && link.inertial->mass > 0) {
        parts_[at].push_back(transformed(declared_inertial(build, link), build.offset[node]));
        if (node == 0) root_has_mass_ = true;
      }
    }
  }

  void run() {
    report_markers();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      LinkModel& link = build_.model.links[i];
      link.inertial = combined(parts_[i]);
      const bool is_static = i == 0 && is_root_fixed(build_);
      if (i == 0) report_root(build_, build_.link(0), root_has_mass_, link.inertial.mass);
      if (is_static) {
        link.inertial = {};
      } else {
        if (i == 0 && !root_has_mass_) add_root_mass(link);
        const bool estimated = link.inertial.mass <= 0;
        if (estimated) estimate(link, lines_[i]);
        regularize(link, lines_[i], estimated || connectors_[i]);
        drop_ground(build_, link, lines_[i]);
      }
      if (link.collisions.empty() && link.visuals.empty() && !connectors_[i]) {
        build_.problems.note(
            lines_[i],
            fmt::format("link '{}' has no shape: it is invisible and does not collide", printable(link.name)),
            "Add a <visual> and a <collision>, unless this is intended.");
      }
    }
  }

 private:
  void report_markers() {
    if (markers_ == 0) return;
    const UrdfLink& first = build_.link(first_marker_);
    build_.problems.note(first.line,
                         fmt::format("{} of {:g} kg or less, first '{}', only {} a frame; {} mass is ignored",
                                     counted(markers_, "link"), kMaxMarkerMass, printable(first.name),
                                     plural(markers_, "marks", "mark"), plural(markers_, "its", "their")),
                         "Nothing to do; scripts find the frames with body:link(name).");
  }

  // a root without a mass that is not fixed: adds the mass of its own shapes to that of the links merged into it
  void add_root_mass(LinkModel& link) {
    const Inertial root_inertial = scaled(shapes_inertial(build_.link(0)), kDensity);
    if (root_inertial.mass <= 0 || link.inertial.mass <= 0) return;
    parts_[0].push_back(root_inertial);
    link.inertial = combined(parts_[0]);
    build_.problems.note(
        lines_[0],
        fmt::format("link '{}' has no mass; using {:.4g} kg from its shape", printable(link.name), root_inertial.mass),
        "Write an <inertial> with mass and inertia.");
  }

  void estimate(LinkModel& link, int line) {
    link.inertial = estimated_inertial(shapes_inertial(link.collisions, link.visuals));
    const bool shapeless = link.collisions.empty() && link.visuals.empty();
    build_.problems.warning(line,
                            fmt::format("link '{}' moves but has no mass; using {:.4g} kg{}", printable(link.name),
                                        link.inertial.mass, shapeless ? "" : " from its shape's volume"),
                            "Write an <inertial> with mass and inertia.");
  }

  void regularize(LinkModel& link, int line, bool silent) {
    bool raised = false;
    if (!tensor_error(link.inertial.tensor).empty()) link.inertial.tensor = sphere_tensor(link.inertial.mass);
    link.inertial.tensor = regularized_tensor(link.inertial.tensor, raised);
    if (!raised || silent) return;
    build_.problems.note(
        line,
        fmt::format("link '{}': its inertia about an axis is too small for a stable simulation; raised",
                    printable(link.name)),
        "Nothing to do; moments of at least 1e-6 kg·m² and a thousandth of the largest are used as they are.");
  }

  UrdfBuildContext& build_;
  std::vector<std::vector<Inertial>> parts_;  // by model link
  std::vector<int> lines_;
  std::vector<bool> connectors_;  // by model link
  bool root_has_mass_ = false;
  std::size_t markers_ = 0;  // links that only mark frames
  std::size_t first_marker_ = 0;
};

}  // namespace

bool is_root_fixed(const UrdfBuildContext& build) {
  const std::optional<UrdfInertial>& inertial = build.link(0).inertial;
  const bool has_mass = inertial && inertial->mass > 0;
  return build.options.fixed_base.value_or(build.file.fixed_root.value_or(!has_mass));
}

void build_masses(UrdfBuildContext& build) { MassBuilder(build).run(); }

}  // namespace limber::model
