// Reads a file with both libraries; bodies have the same order in both.
#include "mjcf_reference.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "model/import.h"
#include "model/mesh/mass_properties.h"
#include "model/mjcf/convert.h"
#include "model/mjcf/document.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_text.h"

namespace limber::model::test {

namespace {

constexpr double kTolerance = 1e-5;

Quat mujoco_quat(const double* q) { return quat_xyzw(q[1], q[2], q[3], q[0]); }

double distance(const Quat& a, const Quat& b) { return std::min(glm::length(a - b), glm::length(a + b)); }

double largest_difference(const Mat3& a, const Mat3& b) {
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  return largest;
}

bool has_mesh_mass(const MjcfBody& body) {
  const auto is_mesh = [](const MjcfGeom& g) { return g.shape.shape.kind == ShapeKind::mesh; };
  return !body.declared && std::any_of(body.geoms.begin(), body.geoms.end(), is_mesh);
}

const FileLink* link_named(const BodyModel& model, const std::string& name) {
  const auto found = std::find_if(model.file_links.begin(), model.file_links.end(),
                                  [&](const FileLink& link) { return link.name == name; });
  return found == model.file_links.end() ? nullptr : &*found;
}

void compare_mass(const mjModel& m, int i, const MjcfBody& body, MujocoComparison& out) {
  const auto at = static_cast<std::size_t>(i);
  Mat3 diagonal(0);
  for (int k = 0; k < 3; ++k) diagonal[k][k] = m.body_inertia[3 * at + static_cast<std::size_t>(k)];
  const Pose frame{vec3_at(m.body_ipos + 3 * at), mujoco_quat(m.body_iquat + 4 * at)};
  const Inertial expected = transformed({m.body_mass[at], Vec3(0), diagonal}, frame);
  const Inertial& own = body.inertial;
  const double size = expected.tensor[0][0] + expected.tensor[1][1] + expected.tensor[2][2];
  out.masses++;
  if (std::abs(own.mass - expected.mass) > kTolerance * expected.mass) {
    out.differences.push_back(fmt::format("'{}': mass {:.9g}, expected {:.9g}", body.name, own.mass, expected.mass));
  } else if (expected.mass > 0 && glm::length(own.center - expected.center) > kTolerance) {
    out.differences.push_back(fmt::format("'{}': center of mass", body.name));
  } else if (largest_difference(own.tensor, expected.tensor) > kTolerance * size) {
    out.differences.push_back(fmt::format("'{}': inertia differs by {:.3g} of {:.3g}", body.name,
                                          largest_difference(own.tensor, expected.tensor), size));
  }
}

void compare_pose(const mjModel& m, const mjData& d, int i, const FileLink* link, const std::string& name,
                  MujocoComparison& out) {
  (void)m;
  const auto at = static_cast<std::size_t>(i);
  out.bodies++;
  if (link == nullptr) {
    out.differences.push_back(fmt::format("'{}' is missing", name));
  } else if (const double gap = glm::length(link->home.position - vec3_at(d.xpos + 3 * at)); gap > kTolerance) {
    out.differences.push_back(fmt::format("'{}': position differs by {:.3g} m", name, gap));
  } else if (distance(link->home.rotation, mujoco_quat(d.xquat + 4 * at)) > kTolerance) {
    out.differences.push_back(fmt::format("'{}': rotation", name));
  }
}

}  // namespace

MujocoComparison compare_with_mujoco(const std::string& path) {
  MujocoComparison out;
  char error[1000] = "";
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> m(mj_loadXML(path.c_str(), nullptr, error, sizeof error),
                                                              mj_deleteModel);
  if (m == nullptr) {
    out.rejected = *error != '\0' ? error : "it can't be read";
    return out;
  }
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> d(mj_makeData(m.get()), mj_deleteData);
  mj_kinematics(m.get(), d.get());

  MeshLibrary meshes;
  Problems problems;
  const Result<std::string> bytes = read_whole_file(path, kMaxUrdfBytes);
  const Result<MjcfDocument> document = bytes ? read_mjcf(*bytes, path, meshes, problems) : Error{bytes.error()};
  if (!document) {
    out.differences.push_back(document.error());
    return out;
  }
  MjcfReader reader(*document, problems);
  Result<MjcfFile> file = MjcfFileReader(*document, reader).run("model");
  if (!file) {
    if (m->nbody > 1) out.differences.push_back(file.error());
    return out;
  }
  complete_names(*file, problems);
  const ImportOptions options;
  std::vector<bool> meshy;  // by body, also if a mesh can't be loaded
  for (const MjcfBody& body : file->bodies) meshy.push_back(has_mesh_mass(body));
  MeshLoader loader(path, options, meshes, problems);
  load_meshes(*file, loader);
  set_masses(*file, reader.compiler);
  if (static_cast<int>(file->bodies.size()) != m->nbody) {
    out.differences.push_back(fmt::format("{} bodies, expected {}", file->bodies.size(), m->nbody));
    return out;
  }
  std::shared_ptr<const BodyModel> tree;
  for (int i = 1; i < m->nbody; ++i) {
    const MjcfBody& body = file->bodies[static_cast<std::size_t>(i)];
    if (body.parent == 0) {
      ImportOptions chosen;
      chosen.root = body.name;
      const auto model = import_model(path, chosen, meshes);
      tree = model ? *model : nullptr;
      if (!model) out.differences.push_back(model.error());
    }
    if (tree != nullptr) compare_pose(*m, *d, i, link_named(*tree, body.name), body.name, out);
    // with settotalmass, the mass of a mesh changes that of all bodies
    const bool total = reader.compiler.total_mass > 0 && std::count(meshy.begin(), meshy.end(), true) > 0;
    if (!meshy[static_cast<std::size_t>(i)] && !total) compare_mass(*m, i, body, out);
  }
  return out;
}

}  // namespace limber::model::test
