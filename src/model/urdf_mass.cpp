// Masses of the body's links: as the file says, else from the shapes; tensors that no body can have are replaced.
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mass_properties.h"
#include "model/urdf_build.h"

namespace limber {

namespace {

constexpr double kDensity = 1000;       // kg/m³, water's
constexpr double kLeastMass = 0.001;    // kg, of links whose mass the file does not say
constexpr double kLeastWritten = 1e-6;  // kg, of links whose mass it does say

/// At density 1: the collision shapes, or the visual ones where there are none.
Inertial shapes_of(const std::vector<PlacedShape>& collisions, const std::vector<PlacedShape>& visuals) {
  std::vector<Inertial> solids;
  for (const PlacedShape& s : collisions.empty() ? visuals : collisions) {
    // a mesh keeps its own volume where it collides as a primitive
    const bool recognised = s.shape.mesh && s.shape.kind != ShapeKind::mesh;
    if (recognised) {
      solids.push_back(moved(s.shape.mesh->solid, s.origin * s.shape.mesh_pose));
    } else {
      solids.push_back(moved(solid_of(s.shape), s.origin));
    }
  }
  return sum_of(solids);
}

Inertial shapes_of(const UrdfLink& link) {
  std::vector<Inertial> solids;
  for (const UrdfShape& s : link.collisions.empty() ? link.visuals : link.collisions) {
    solids.push_back(moved(solid_of(s.shape), s.origin.pose()));
  }
  return sum_of(solids);
}

/// A tensor of the right size when there is no shape to take one from: a ball of water.
Mat3 ball_tensor(double mass) {
  const double radius = fixed::cbrt(mass / kDensity * 3 / (4 * kPi));
  return Mat3(0.4 * mass * radius * radius);
}

Inertial derived(Inertial shapes) {
  Inertial out = scaled(shapes, kDensity);
  if (out.mass >= kLeastMass) return out;
  return shapes.mass > 0 ? scaled(shapes, kLeastMass / shapes.mass)
                         : Inertial{kLeastMass, Vec3(0), ball_tensor(kLeastMass)};
}

/// What the file says of one link with a mass, in the link's frame, its tensor made possible.
Inertial written(UrdfBuild& build, const UrdfLink& link) {
  const UrdfInertial& from = *link.inertial;
  Inertial out = moved({from.mass, Vec3(0), from.tensor}, from.origin.pose());
  if (out.mass < kLeastWritten) {
    build.problems.warning(link.line,
                           fmt::format("link '{}': its mass of {:g} kg is too small; {:g} kg is taken",
                                       printable(link.name), out.mass, kLeastWritten),
                           "Write a mass of some grams at least.");
    out = scaled(out, kLeastWritten / out.mass);
  }
  const std::string fault = from.has_tensor ? tensor_fault(out.tensor) : "there is none";
  if (fault.empty()) return out;
  const Inertial shapes = shapes_of(link);
  const bool usable = shapes.mass > 0 && tensor_fault(shapes.tensor).empty();
  out.tensor = usable ? shapes.tensor * (out.mass / shapes.mass) : ball_tensor(out.mass);
  if (from.has_tensor) {
    build.problems.warning(link.line,
                           fmt::format("link '{}': its inertia tensor can't be ({}); {} is taken", printable(link.name),
                                       fault, usable ? "its shape's" : "that of a ball of its mass"),
                           "Write the tensor about the centre of mass, in kg·m².");
  }
  return out;
}

void drop_planes(UrdfBuild& build, LinkModel& link, int line) {
  const auto is_plane = [](const PlacedShape& s) { return s.shape.kind == ShapeKind::plane; };
  if (std::erase_if(link.collisions, is_plane) == 0) return;
  build.problems.error(
      line, fmt::format("link '{}' moves, so it can't have a <plane> to collide with; left out", printable(link.name)),
      "Use a box, or put the plane into the fixed root.");
}

void say_root(UrdfBuild& build, const UrdfLink& root, bool has_mass, double merged_mass) {
  const std::string name = printable(root.name);
  if (!build.options.fixed_base.has_value() && !has_mass) {
    const std::string also =
        merged_mass > 0 ? fmt::format(", with the {:.4g} kg that are fixed to it", merged_mass) : "";
    build.problems.note(root.line, fmt::format("root link '{}' has no mass; it is fixed to the world{}", name, also),
                        "Give it an <inertial>, or load with fixed_base = false, to let it move.");
  }
}

class Masses {
 public:
  explicit Masses(UrdfBuild& build) : build_(build) {
    parts_.resize(build.model.links.size());
    lines_.resize(build.model.links.size());
    for (std::size_t node = 0; node < build.tree.size(); ++node) {
      const auto at = static_cast<std::size_t>(build.body_link[node]);
      const UrdfLink& link = build.link(node);
      if (lines_[at] == 0) lines_[at] = link.line;
      if (link.inertial && link.inertial->mass > 0) {
        parts_[at].push_back(moved(written(build, link), build.offset[node]));
        if (node == 0) root_has_mass_ = true;
      }
    }
  }

  void run() {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      LinkModel& link = build_.model.links[i];
      link.inertial = sum_of(parts_[i]);
      const bool is_static = i == 0 && build_.options.fixed_base.value_or(!root_has_mass_);
      if (i == 0) say_root(build_, build_.link(0), root_has_mass_, link.inertial.mass);
      if (is_static) {
        link.inertial = {};
      } else {
        if (i == 0 && !root_has_mass_) add_root_mass(link);
        const bool derived = link.inertial.mass <= 0;
        if (derived) derive(link, lines_[i]);
        settle(link, lines_[i], derived);
        drop_planes(build_, link, lines_[i]);
      }
      if (link.collisions.empty() && link.visuals.empty()) {
        build_.problems.note(
            lines_[i], fmt::format("link '{}' has no shape: it is neither seen nor touched", printable(link.name)),
            "Add a <visual> and a <collision>, unless that is meant.");
      }
    }
  }

 private:
  // a massless root that is let go: its own shapes' mass, beside what is merged into it
  void add_root_mass(LinkModel& link) {
    const Inertial own = scaled(shapes_of(build_.link(0)), kDensity);
    if (own.mass <= 0 || link.inertial.mass <= 0) return;
    parts_[0].push_back(own);
    link.inertial = sum_of(parts_[0]);
    build_.problems.note(
        lines_[0],
        fmt::format("link '{}' has no mass; {:.4g} kg are taken from its shape", printable(link.name), own.mass),
        "Write an <inertial> with mass and inertia.");
  }

  void derive(LinkModel& link, int line) {
    link.inertial = derived(shapes_of(link.collisions, link.visuals));
    const bool shapeless = link.collisions.empty() && link.visuals.empty();
    build_.problems.warning(line,
                            fmt::format("link '{}' moves but has no mass; {:.4g} kg are taken{}", printable(link.name),
                                        link.inertial.mass, shapeless ? "" : " from its shape's volume"),
                            "Write an <inertial> with mass and inertia.");
  }

  void settle(LinkModel& link, int line, bool derived) {
    bool raised = false;
    if (!tensor_fault(link.inertial.tensor).empty()) link.inertial.tensor = ball_tensor(link.inertial.mass);
    link.inertial.tensor = solvable_tensor(link.inertial.tensor, raised);
    if (!raised || derived) return;
    build_.problems.note(
        line,
        fmt::format("link '{}': its inertia is too small about an axis for a steady simulation; raised",
                    printable(link.name)),
        "Nothing to do; moments of at least 1e-6 kg·m² and a thousandth of the largest are used as they are.");
  }

  UrdfBuild& build_;
  std::vector<std::vector<Inertial>> parts_;  // by model link
  std::vector<int> lines_;
  bool root_has_mass_ = false;
};

}  // namespace

void build_masses(UrdfBuild& build) { Masses(build).run(); }

}  // namespace limber
