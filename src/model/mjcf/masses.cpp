// Masses of the bodies, with the rules of MuJoCo's compiler.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/mass_properties.h"
#include "model/mjcf/convert.h"
#include "model/pieces/pieces.h"

namespace limber::model {

namespace {

Inertial geom_inertial(const MjcfGeom& geom) {
  const Inertial unit = unit_inertial_of(geom.shape.shape);
  if (unit.mass <= 0) return {};
  const double density = geom.mass ? *geom.mass / unit.mass : geom.density;
  return transformed(scaled(unit, density), geom.shape.origin.pose());
}

Inertial inertial_of_geoms(const MjcfBody& body, const MjcfCompiler& compiler) {
  std::vector<Inertial> solids;
  for (const MjcfGeom& geom : body.geoms) {
    if (geom.group < compiler.first_group || geom.group > compiler.last_group) continue;
    const Inertial solid = geom_inertial(geom);
    if (solid.mass > 0) solids.push_back(solid);
  }
  return combined(solids);
}

// boundmass, boundinertia, balanceinertia
void bound(Inertial& inertial, const MjcfCompiler& compiler) {
  inertial.mass = std::max(inertial.mass, compiler.bound_mass);
  if (compiler.bound_inertia <= 0 && !compiler.balance_inertia) return;
  PrincipalAxes principal = principal_axes(inertial.tensor);
  Vec3& moments = principal.moments;
  for (int i = 0; i < 3; ++i) moments[i] = std::max(moments[i], compiler.bound_inertia);
  const bool unbalanced = moments.x + moments.y < moments.z;  // ascending
  if (compiler.balance_inertia && unbalanced) moments = Vec3((moments.x + moments.y + moments.z) / 3);
  const Mat3 diagonal(moments.x, 0, 0, 0, moments.y, 0, 0, 0, moments.z);
  inertial.tensor = principal.axes * diagonal * glm::transpose(principal.axes);
}

}  // namespace

void load_meshes(MjcfFile& file, MeshLoader& loader) {
  std::map<std::shared_ptr<const MeshModel>, std::shared_ptr<const MeshModel>> joined;
  for (MjcfBody& body : file.bodies) {
    const std::string owner = fmt::format("body '{}':", printable(body.name));
    std::erase_if(body.geoms, [&](MjcfGeom& geom) { return !loader.load(geom.shape, owner); });
    // a mesh is one hull in MuJoCo, also if its file has several objects
    for (MjcfGeom& geom : body.geoms) {
      const std::shared_ptr<const MeshModel>& mesh = geom.shape.shape.mesh;
      if (mesh == nullptr || (mesh->pieces.empty() && mesh->collision_problems.empty())) continue;
      std::shared_ptr<const MeshModel>& whole = joined[mesh];
      if (whole == nullptr) whole = without_pieces(*mesh);
      geom.shape.shape.mesh = whole;
    }
  }
}

void set_masses(MjcfFile& file, const MjcfCompiler& compiler) {
  double total = 0;
  for (std::size_t i = 1; i < file.bodies.size(); ++i) {
    MjcfBody& body = file.bodies[i];
    if (body.declared) {
      const UrdfInertial& from = *body.declared;
      body.inertial = transformed({from.mass, Vec3(0), from.tensor}, from.origin.pose());
    } else if (compiler.inertia_from_geoms != MjcfCompiler::FromGeoms::no) {
      body.inertial = inertial_of_geoms(body, compiler);
    }
    bound(body.inertial, compiler);
    total += body.inertial.mass;
  }
  if (compiler.total_mass <= 0 || total <= 0) return;
  for (MjcfBody& body : file.bodies) body.inertial = scaled(body.inertial, compiler.total_mass / total);
}

}  // namespace limber::model
