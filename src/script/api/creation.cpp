// C API: creating bodies, parts, joints, motors, shapes; loading model files (URDF, MJCF).
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "model/look/mesh_look.h"
#include "model/mesh/hull.h"
#include "model/mesh/mass_properties.h"
#include "model/problems.h"
#include "script/api/script_context.h"
#include "sim/gears/gear_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::script {

bool is_full(ScriptContext& c) {
  const std::size_t max = c.options.limits.max_objects;
  if (c.world->store().view()->slot_count < max) return false;
  c.reject(fmt::format("a scene can have at most {} objects (bodies, parts, joints, motors, shapes)", max));
  return true;
}

namespace calls {

namespace {

constexpr std::size_t kMaxPoints = 1000;  // max. points of a hull created by a callback: about 10 ms

Pose pose_at(const double* v) { return {{v[0], v[1], v[2]}, glm::normalize(quat_xyzw(v[3], v[4], v[5], v[6]))}; }

template <class T>
std::int32_t creation_result(ScriptContext& c, const Result<T*>& thing) {
  return thing ? c.set_id((*thing)->id()) : c.reject(thing.error());
}

// pose of a body's root; NaN means "as the model places it"
void set_placement(sim::BuildOptions& build, const double* pose) {
  build.position.reset();
  build.rotation.reset();
  if (std::isfinite(pose[0])) build.position = Vec3(pose[0], pose[1], pose[2]);
  if (std::isfinite(pose[3])) build.rotation = glm::normalize(quat_xyzw(pose[3], pose[4], pose[5], pose[6]));
}

// values given at the top level on creation count as explicitly set
void mark_explicit(const ScriptContext& c, NodeId id, std::string_view property) {
  Store& store = c.world->store();
  if (c.answer.top_level != 0) store.mark_explicitly_set(id, store.table(id).at(property));
}
void mark_pose_explicit(const ScriptContext& c, NodeId id, const sim::BuildOptions& options) {
  if (options.position) mark_explicit(c, id, "position");
  if (options.rotation) mark_explicit(c, id, "rotation");
}

void log_problems(const model::BodyModel& model) {
  for (const std::string& line : model::load_messages(model)) log_warning("{}", line);
}

// hull of points given by a script, or of a mesh file with a different vertex limit
std::shared_ptr<model::MeshModel> mesh_of_points(std::vector<Vec3> points, std::string name, int max_vertices,
                                                 double tolerance) {
  const model::Hull hull = model::reduced_hull(points, {16, max_vertices, tolerance});
  auto mesh = std::make_shared<model::MeshModel>();
  mesh->name = std::move(name);
  mesh->vertices = hull.vertices;
  mesh->triangles = hull.triangles;
  mesh->hull = hull.vertices;
  mesh->hull_error = hull.error;
  mesh->closed = true;
  mesh->unit_inertial = model::unit_inertial_of(hull.vertices, hull.triangles);
  return mesh;
}

// gives each piece that is a hull at most `max_vertices`
void limit_pieces(model::MeshModel& mesh, int max_vertices) {
  for (model::PlacedShape& piece : mesh.pieces) {
    if (piece.shape.mesh == nullptr) continue;
    auto changed = std::make_shared<model::MeshModel>(*piece.shape.mesh);
    const model::Hull hull = model::reduced_hull(
        changed->vertices, {std::min(16, max_vertices), max_vertices, model::HullLimits{}.tolerance});
    changed->hull = hull.vertices;
    changed->hull_error = hull.error;
    mesh.hull_error = std::max(mesh.hull_error, hull.error);
    piece.shape.mesh = std::move(changed);
  }
}

Error not_loaded(std::string_view file) {
  return Error{
      fmt::format("'{}' was not loaded with these options when the scene ran; callbacks can't read files, so load it "
                  "once at the top level",
                  file)};
}

// Reports the colors and textures of a mesh file that are not drawn, and its defects as a collision shape.
void report_problems(const std::string& path, const model::MeshModel& mesh) {
  for (const model::Problem& problem : mesh.collision_problems)
    log_warning("{}: {}. {}", printable(path), problem.text, problem.fix);
  if (mesh.look == nullptr) return;
  for (const model::Problem& problem : mesh.look->problems) {
    if (problem.severity != model::Severity::note)
      log_warning("{}: {}. {}", printable(path), problem.text, problem.fix);
  }
}

struct MeshOptions {
  Vec3 scale{1};
  int max_vertices = model::HullLimits{}.max_vertices;
  bool concave = false;
};

Result<std::shared_ptr<const model::MeshModel>> read_mesh(const ScriptContext& c, std::string_view file,
                                                          const MeshOptions& options) {
  const Result<std::string> path = c.sources->find(c.files, file);
  if (!path) return Error{path.error()};
  Result<std::shared_ptr<const model::MeshModel>> mesh = c.sources->mesh(*path, options.scale, options.concave);
  if (mesh) report_problems(*path, **mesh);
  const int max_vertices = options.max_vertices;
  if (!mesh || max_vertices == model::HullLimits{}.max_vertices) return mesh;
  auto changed = std::make_shared<model::MeshModel>(**mesh);
  const model::Hull hull =
      model::reduced_hull(changed->vertices, {std::min(16, max_vertices), max_vertices, model::HullLimits{}.tolerance});
  changed->hull = hull.vertices;
  changed->hull_error = hull.error;
  limit_pieces(*changed, max_vertices);
  return std::shared_ptr<const model::MeshModel>(std::move(changed));
}

Result<std::shared_ptr<const model::MeshModel>> mesh_of_file(ScriptContext& c, std::string_view file,
                                                             const MeshOptions& options) {
  const Vec3& scale = options.scale;
  const std::string key = fmt::format("{}|{:a}|{:a}|{:a}|{}{}", file, scale.x, scale.y, scale.z, options.max_vertices,
                                      options.concave ? "|concave" : "");
  const auto known = c.loaded.meshes.find(key);
  if (known != c.loaded.meshes.end()) return known->second;
  if (c.answer.top_level == 0) return not_loaded(file);
  Result<std::shared_ptr<const model::MeshModel>> mesh = read_mesh(c, file, options);
  if (mesh) c.loaded.meshes[key] = *mesh;
  return mesh;
}

Result<std::shared_ptr<const model::BodyModel>> model_of_file(ScriptContext& c, std::string_view file) {
  const std::string key = fmt::format("{}|{}", file, model::options_key(c.arguments.import));
  const auto known = c.loaded.models.find(key);
  if (known != c.loaded.models.end()) return known->second;
  if (c.answer.top_level == 0) return not_loaded(file);
  const Result<std::string> path = c.sources->find(c.files, file);
  if (!path) return Error{path.error()};
  Result<std::shared_ptr<const model::BodyModel>> model = c.sources->model(*path, c.arguments.import);
  if (!model) return model;
  log_problems(**model);
  c.loaded.models[key] = *model;
  return model;
}

}  // namespace

std::int32_t add_body(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  return creation_result(context, context.world->add_body(std::string(text_of(name, length))));
}

std::int32_t copy_body(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  const sim::Body* source = object_of<sim::Body>(context, id_of(slot, generation));
  if (source == nullptr) return kRemoved;
  return creation_result(context, context.world->copy_body(*source, std::string(text_of(name, length))));
}

std::int32_t remove_body(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  sim::Body* body = object_of<sim::Body>(context, id_of(slot, generation));
  if (body == nullptr) return kRemoved;
  context.world->remove_body(*body);
  return kOk;
}

std::int32_t edit_pair(void* c, std::int32_t slot, std::int32_t generation, std::int32_t a_slot,
                       std::int32_t a_generation, std::int32_t b_slot, std::int32_t b_generation, std::int32_t edit) {
  ScriptContext& context = context_of(c);
  sim::Body* const body = object_of<sim::Body>(context, id_of(slot, generation));
  const sim::Part* const a = object_of<sim::Part>(context, id_of(a_slot, a_generation));
  const sim::Part* const b = object_of<sim::Part>(context, id_of(b_slot, b_generation));
  if (body == nullptr || a == nullptr || b == nullptr) return kRemoved;
  const Result<void> done = body->pairs().edit(*a, *b, static_cast<sim::PairEdit>(edit));
  if (!done) return context.reject(done.error());
  if (static_cast<sim::PairEdit>(edit) != sim::PairEdit::included) return kOk;
  for (const auto& joint : body->joints()) {
    const bool joined =
        (&joint->parent() == a && &joint->child() == b) || (&joint->parent() == b && &joint->child() == a);
    if (!joined) continue;
    log_warning("body '{}': include_pair('{}', '{}') has no effect while joint '{}' connects the two", body->name(),
                a->name(), b->name(), joint->name());
    break;
  }
  return kOk;
}

std::int32_t excluded_pair(void* c, std::int32_t slot, std::int32_t generation, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const sim::Body* const body = object_of<sim::Body>(context, id_of(slot, generation));
  if (body == nullptr) return kRemoved;
  std::int32_t count = 0;
  for (const sim::PartPair& pair : body->pairs().list()) {
    if (!pair.excluded() || count++ != index) continue;
    context.answer.number[0] = pair.a;
    context.answer.number[1] = pair.b;
    return kOk;
  }
  context.answer.number[0] = count;
  return kOk;
}

std::int32_t add_part(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length,
                      std::int32_t shape_slot, std::int32_t shape_generation, double mass, const double* pose) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  sim::Body* body = object_of<sim::Body>(context, id_of(slot, generation));
  sim::Shape* shape = object_of<sim::Shape>(context, id_of(shape_slot, shape_generation));
  if (body == nullptr || shape == nullptr) return kRemoved;
  // by default the first part is placed at the body's pose
  const Pose default_pose = body->parts().empty() ? body->pose() : Pose{};
  sim::BuildOptions placement;
  set_placement(placement, pose);
  const Pose at{placement.position.value_or(default_pose.position), placement.rotation.value_or(default_pose.rotation)};
  // a negative mass means "not given"
  const double used_mass = mass >= 0 ? mass : model::is_ground(shape->model()) ? 0 : 1;
  const Result<sim::Part*> part = body->add_part(std::string(text_of(name, length)), *shape, used_mass, at);
  if (part && mass > 0) mark_explicit(context, (*part)->id(), "mass");
  if (part) mark_pose_explicit(context, (*part)->id(), placement);
  return creation_result(context, part);
}

std::int32_t add_joint(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length,
                       const char* type, std::int32_t type_length, std::int32_t parent_slot, std::int32_t child_slot,
                       const double* at) {
  ScriptContext& context = context_of(c);
  const Store& store = context.world->store();
  const auto part_at = [&](std::int32_t part_slot) {
    const auto of_slot = static_cast<std::size_t>(part_slot);
    return object_of<sim::Part>(context,
                                id_of(part_slot, static_cast<std::int32_t>(store.view()->slots[of_slot].generation)));
  };
  sim::Body* body = object_of<sim::Body>(context, id_of(slot, generation));
  sim::Part* parent = part_at(parent_slot);
  sim::Part* child = part_at(child_slot);
  if (body == nullptr || parent == nullptr || child == nullptr) return kRemoved;
  const std::string_view type_text = text_of(type, type_length);
  const std::optional<model::JointType> wanted = model::joint_type_named(type_text);
  if (!wanted) {
    const std::vector<std::string> types = {"revolute", "prismatic", "spherical", "planar", "floating", "fixed"};
    return context.reject(fmt::format("joint '{}/{}': there is no joint type '{}'{}", body->name(),
                                      text_of(name, length), printable(type_text), name_hint(type_text, types)));
  }
  return creation_result(context, body->add_joint(std::string(text_of(name, length)), *parent, *child, *wanted,
                                                  {at[0], at[1], at[2]}, {at[3], at[4], at[5]}));
}

std::int32_t add_motor(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  sim::Joint* joint = object_of<sim::Joint>(context, id_of(slot, generation));
  if (joint == nullptr) return kRemoved;
  return creation_result(context, joint->body().add_motor(*joint));
}

std::int32_t add_gear(void* c, const char* name, std::int32_t length, std::int32_t slot_a, std::int32_t generation_a,
                      std::int32_t slot_b, std::int32_t generation_b, double ratio, double offset) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  sim::Joint* a = object_of<sim::Joint>(context, id_of(slot_a, generation_a));
  sim::Joint* b = object_of<sim::Joint>(context, id_of(slot_b, generation_b));
  if (a == nullptr || b == nullptr) return kRemoved;
  const bool given = !std::isnan(offset);
  const Result<sim::Gear*> gear = context.world->gears().add(std::string(text_of(name, length)), *a, *b, ratio,
                                                             given ? std::optional(offset) : std::nullopt);
  if (gear && given) mark_explicit(context, (*gear)->id(), "offset");
  return creation_result(context, gear);
}

std::int32_t add_shape(void* c, const char* name, std::int32_t length, const char* kind, const double* n) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  const std::string_view wanted(kind);
  model::ShapeModel model;
  if (wanted == "plane") {
    model.kind = model::ShapeKind::plane;
    model.normal = {n[0], n[1], n[2]};
  } else if (wanted == "box") {
    model.kind = model::ShapeKind::box;
    model.size = {n[0], n[1], n[2]};
  } else if (wanted == "ellipsoid") {
    model.kind = model::ShapeKind::ellipsoid;
    model.size = 2.0 * Vec3(n[0], n[1], n[2]);
  } else if (wanted == "compound") {
    model.kind = model::ShapeKind::compound;
  } else {
    model.kind = wanted == "sphere"     ? model::ShapeKind::sphere
                 : wanted == "cylinder" ? model::ShapeKind::cylinder
                 : wanted == "capsule"  ? model::ShapeKind::capsule
                                        : model::ShapeKind::cone;
    model.radius = n[0];
    model.height = n[1];
  }
  return creation_result(context, context.world->shapes().add(std::string(text_of(name, length)), std::move(model)));
}

std::int32_t add_child(void* c, std::int32_t slot, std::int32_t generation, std::int32_t child_slot,
                       std::int32_t child_generation, const double* pose) {
  ScriptContext& context = context_of(c);
  sim::Shape* shape = object_of<sim::Shape>(context, id_of(slot, generation));
  const sim::Shape* child = object_of<sim::Shape>(context, id_of(child_slot, child_generation));
  if (shape == nullptr || child == nullptr) return kRemoved;
  context.world->transaction().save(*shape);
  const Result<void> done = shape->add_child(*child, pose_at(pose));
  return done ? kOk : context.reject(done.error());
}

void mesh_clear(void* c) { context_of(c).arguments.mesh_points.clear(); }

void mesh_point(void* c, double x, double y, double z) { context_of(c).arguments.mesh_points.emplace_back(x, y, z); }

std::int32_t add_mesh_shape(void* c, const char* name, std::int32_t length, const char* file, std::int32_t file_length,
                            double sx, double sy, double sz, std::int32_t max_vertices, std::int32_t concave) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  const Vec3 scale(sx, sy, sz);
  model::ShapeModel model;
  model.kind = model::ShapeKind::mesh;
  if (file_length > 0) {
    const auto mesh = mesh_of_file(context, text_of(file, file_length), {scale, max_vertices, concave != 0});
    if (!mesh) return context.reject(mesh.error());
    model.mesh = *mesh;
  } else {
    std::vector<Vec3> points = context.arguments.mesh_points;
    if (context.answer.top_level == 0 && points.size() > kMaxPoints) {
      return context.reject(fmt::format(
          "a convex mesh of {} points takes too long in a callback; the maximum there is {}, more at the top level",
          points.size(), kMaxPoints));
    }
    for (Vec3& point : points) point *= scale;
    model.mesh = mesh_of_points(std::move(points), std::string(text_of(name, length)), max_vertices, 0);
  }
  return creation_result(context, context.world->shapes().add(std::string(text_of(name, length)), std::move(model)));
}

void urdf_clear(void* c) {
  ScriptContext& context = context_of(c);
  context.arguments.import = {};
  context.arguments.import.package_paths = context.options.package_paths;
  context.arguments.build = {};
}

void urdf_flag(void* c, std::int32_t which, std::int32_t on) {
  ScriptContext& context = context_of(c);
  if (which == 0) context.arguments.import.fixed_base = on != 0;
  if (which == 1) context.arguments.import.keep_fixed = on != 0;
  if (which == 2) context.arguments.build.servo_motors = on != 0;
}

void urdf_pose(void* c, const char* joint, std::int32_t length, double value) {
  context_of(c).arguments.import.pose[std::string(text_of(joint, length))] = value;
}

void urdf_package_path(void* c, const char* path, std::int32_t length) {
  context_of(c).arguments.import.package_paths.emplace_back(text_of(path, length));
}

void urdf_root(void* c, const char* body, std::int32_t length) {
  context_of(c).arguments.import.root = std::string(text_of(body, length));
}

std::int32_t load_urdf(void* c, const char* path, std::int32_t path_length, const char* name, std::int32_t length,
                       const double* pose) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  const auto model = model_of_file(context, text_of(path, path_length));
  if (!model) return context.reject(model.error());
  set_placement(context.arguments.build, pose);
  const std::string body_name = length > 0 ? std::string(text_of(name, length)) : (*model)->name;
  const Result<sim::Body*> body = context.world->add_body(*model, body_name, context.arguments.build);
  if (body) mark_pose_explicit(context, (*body)->id(), context.arguments.build);
  return creation_result(context, body);
}

}  // namespace calls
}  // namespace limber::script
