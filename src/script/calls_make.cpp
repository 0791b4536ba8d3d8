// Behind the door: bodies, parts, joints, motors, shapes, URDF files.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "model/hull.h"
#include "model/load_messages.h"
#include "model/mass_properties.h"
#include "script/context.h"

namespace limber::calls {

namespace {

constexpr std::size_t kMostPoints = 1000;  // of a hull that a callback asks for: about 10 ms

Pose pose_at(const double* v) { return {{v[0], v[1], v[2]}, glm::normalize(quat_xyzw(v[3], v[4], v[5], v[6]))}; }

template <class T>
std::int32_t made(ScriptContext& c, const Result<T*>& thing) {
  return thing ? c.tell((*thing)->id()) : c.refuse(thing.error());
}

// a loop that makes things must not take the machine's memory before it is stopped
bool is_full(ScriptContext& c) {
  const std::size_t most = c.options.limits.things;
  if (c.world->store().view()->slot_count < most) return false;
  c.refuse(fmt::format("a scene may have {} things (bodies, their parts, joints and motors, shapes)", most));
  return true;
}

// where a body's root goes: NaN means "as the model places it"
void place(BuildOptions& build, const double* pose) {
  build.position.reset();
  build.rotation.reset();
  if (std::isfinite(pose[0])) build.position = Vec3(pose[0], pose[1], pose[2]);
  if (std::isfinite(pose[3])) build.rotation = glm::normalize(quat_xyzw(pose[3], pose[4], pose[5], pose[6]));
}

// what the top level gives when it makes a thing is said as if it were set
void say(const ScriptContext& c, NodeId id, std::string_view row) {
  Store& store = c.world->store();
  if (c.answer.top_level != 0) store.say(id, store.table(id).at(row));
}
void say_place(const ScriptContext& c, NodeId id, const BuildOptions& place) {
  if (place.position) say(c, id, "position");
  if (place.rotation) say(c, id, "rotation");
}

void say_problems(const BodyModel& model) {
  for (const std::string& line : load_messages(model)) log_warning("{}", line);
}

// hull of points that a script gave, or of a file's mesh with another count of vertices
std::shared_ptr<MeshModel> mesh_of_points(std::vector<Vec3> points, std::string name, int max_vertices,
                                          double tolerance) {
  const Hull hull = reduced_hull(points, {16, max_vertices, tolerance});
  auto mesh = std::make_shared<MeshModel>();
  mesh->name = std::move(name);
  mesh->vertices = hull.vertices;
  mesh->triangles = hull.triangles;
  mesh->hull = hull.vertices;
  mesh->hull_error = hull.error;
  mesh->closed = true;
  mesh->solid = solid_of(hull.vertices, hull.triangles);
  return mesh;
}

Error not_loaded(std::string_view file) {
  return Error{
      fmt::format("'{}' was not loaded like this when the scene ran; a callback must not wait for a disk, so load it "
                  "once at the top level",
                  file)};
}

Result<std::shared_ptr<const MeshModel>> read_mesh(const ScriptContext& c, std::string_view file, const Vec3& scale,
                                                   int max_vertices) {
  const Result<std::string> path = c.sources->find(c.files, file);
  if (!path) return Error{path.error()};
  Result<std::shared_ptr<const MeshModel>> mesh = c.sources->mesh(*path, scale);
  if (!mesh || max_vertices == HullLimits{}.max_vertices) return mesh;
  auto changed = std::make_shared<MeshModel>(**mesh);
  const Hull hull = reduced_hull(changed->vertices, {std::min(16, max_vertices), max_vertices, HullLimits{}.tolerance});
  changed->hull = hull.vertices;
  changed->hull_error = hull.error;
  return std::shared_ptr<const MeshModel>(std::move(changed));
}

Result<std::shared_ptr<const MeshModel>> mesh_of_file(ScriptContext& c, std::string_view file, const Vec3& scale,
                                                      int max_vertices) {
  const std::string key = fmt::format("{}|{:a}|{:a}|{:a}|{}", file, scale.x, scale.y, scale.z, max_vertices);
  const auto known = c.loaded_meshes.find(key);
  if (known != c.loaded_meshes.end()) return known->second;
  if (c.answer.top_level == 0) return not_loaded(file);
  Result<std::shared_ptr<const MeshModel>> mesh = read_mesh(c, file, scale, max_vertices);
  if (mesh) c.loaded_meshes[key] = *mesh;
  return mesh;
}

Result<std::shared_ptr<const BodyModel>> model_of_file(ScriptContext& c, std::string_view file) {
  const std::string key = fmt::format("{}|{}", file, options_key(c.import));
  const auto known = c.loaded_models.find(key);
  if (known != c.loaded_models.end()) return known->second;
  if (c.answer.top_level == 0) return not_loaded(file);
  const Result<std::string> path = c.sources->find(c.files, file);
  if (!path) return Error{path.error()};
  Result<std::shared_ptr<const BodyModel>> model = c.sources->model(*path, c.import);
  if (!model) return model;
  say_problems(**model);
  c.loaded_models[key] = *model;
  return model;
}

}  // namespace

std::int32_t add_body(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRefused;
  return made(context, context.world->add_body(std::string(text_of(name, length))));
}

std::int32_t copy_body(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRefused;
  const Body* source = thing_of<Body>(context, id_of(slot, generation));
  if (source == nullptr) return kGone;
  return made(context, context.world->copy_body(*source, std::string(text_of(name, length))));
}

std::int32_t remove_body(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  Body* body = thing_of<Body>(context, id_of(slot, generation));
  if (body == nullptr) return kGone;
  context.world->remove_body(*body);
  return kOk;
}

std::int32_t edit_pair(void* c, std::int32_t slot, std::int32_t generation, std::int32_t a_slot,
                       std::int32_t a_generation, std::int32_t b_slot, std::int32_t b_generation, std::int32_t edit) {
  ScriptContext& context = context_of(c);
  Body* const body = thing_of<Body>(context, id_of(slot, generation));
  const Part* const a = thing_of<Part>(context, id_of(a_slot, a_generation));
  const Part* const b = thing_of<Part>(context, id_of(b_slot, b_generation));
  if (body == nullptr || a == nullptr || b == nullptr) return kGone;
  const Result<void> done = body->edit_pair(*a, *b, static_cast<PairEdit>(edit));
  if (!done) return context.refuse(done.error());
  if (static_cast<PairEdit>(edit) != PairEdit::included) return kOk;
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
  const Body* const body = thing_of<Body>(context, id_of(slot, generation));
  if (body == nullptr) return kGone;
  std::int32_t count = 0;
  for (const PartPair& pair : body->pairs().list) {
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
  if (is_full(context)) return kRefused;
  Body* body = thing_of<Body>(context, id_of(slot, generation));
  Shape* shape = thing_of<Shape>(context, id_of(shape_slot, shape_generation));
  if (body == nullptr || shape == nullptr) return kGone;
  // where nothing is said, the first part is where the body was put
  const Pose usual = body->parts().empty() ? body->pose() : Pose{};
  BuildOptions said;
  place(said, pose);
  const Pose at{said.position.value_or(usual.position), said.rotation.value_or(usual.rotation)};
  // a mass below zero: not said
  const double given = mass >= 0 ? mass : shape->model().kind == ShapeKind::plane ? 0 : 1;
  const Result<Part*> part = body->add_part(std::string(text_of(name, length)), *shape, given, at);
  if (part && mass > 0) say(context, (*part)->id(), "mass");
  if (part) say_place(context, (*part)->id(), said);
  return made(context, part);
}

std::int32_t add_joint(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length,
                       const char* type, std::int32_t type_length, std::int32_t parent_slot, std::int32_t child_slot,
                       const double* at) {
  ScriptContext& context = context_of(c);
  const Store& store = context.world->store();
  const auto part_at = [&](std::int32_t part_slot) {
    const auto of_slot = static_cast<std::size_t>(part_slot);
    return thing_of<Part>(context,
                          id_of(part_slot, static_cast<std::int32_t>(store.view()->slots[of_slot].generation)));
  };
  Body* body = thing_of<Body>(context, id_of(slot, generation));
  Part* parent = part_at(parent_slot);
  Part* child = part_at(child_slot);
  if (body == nullptr || parent == nullptr || child == nullptr) return kGone;
  const std::string_view type_text = text_of(type, type_length);
  const std::optional<JointType> wanted = joint_type_named(type_text);
  if (!wanted) {
    const std::vector<std::string> types = {"revolute", "prismatic", "spherical", "planar", "floating", "fixed"};
    return context.refuse(fmt::format("joint '{}/{}': there is no joint type '{}'{}", body->name(),
                                      text_of(name, length), printable(type_text), name_hint(type_text, types)));
  }
  return made(context, body->add_joint(std::string(text_of(name, length)), *parent, *child, *wanted,
                                       {at[0], at[1], at[2]}, {at[3], at[4], at[5]}));
}

std::int32_t add_motor(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  Joint* joint = thing_of<Joint>(context, id_of(slot, generation));
  if (joint == nullptr) return kGone;
  return made(context, joint->body().add_motor(*joint));
}

std::int32_t add_gear(void* c, const char* name, std::int32_t length, std::int32_t slot_a, std::int32_t generation_a,
                      std::int32_t slot_b, std::int32_t generation_b, double ratio, double offset) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRefused;
  Joint* a = thing_of<Joint>(context, id_of(slot_a, generation_a));
  Joint* b = thing_of<Joint>(context, id_of(slot_b, generation_b));
  if (a == nullptr || b == nullptr) return kGone;
  const bool given = !std::isnan(offset);
  const Result<Gear*> gear = context.world->add_gear(std::string(text_of(name, length)), *a, *b, ratio,
                                                     given ? std::optional(offset) : std::nullopt);
  if (gear && given) say(context, (*gear)->id(), "offset");
  return made(context, gear);
}

std::int32_t add_shape(void* c, const char* name, std::int32_t length, const char* kind, const double* n) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRefused;
  const std::string_view wanted(kind);
  ShapeModel model;
  if (wanted == "plane") {
    model.kind = ShapeKind::plane;
    model.normal = {n[0], n[1], n[2]};
  } else if (wanted == "box") {
    model.kind = ShapeKind::box;
    model.size = {n[0], n[1], n[2]};
  } else if (wanted == "compound") {
    model.kind = ShapeKind::compound;
  } else {
    model.kind = wanted == "sphere"     ? ShapeKind::sphere
                 : wanted == "cylinder" ? ShapeKind::cylinder
                 : wanted == "capsule"  ? ShapeKind::capsule
                                        : ShapeKind::cone;
    model.radius = n[0];
    model.height = n[1];
  }
  return made(context, context.world->add_shape(std::string(text_of(name, length)), std::move(model)));
}

std::int32_t add_child(void* c, std::int32_t slot, std::int32_t generation, std::int32_t child_slot,
                       std::int32_t child_generation, const double* pose) {
  ScriptContext& context = context_of(c);
  Shape* shape = thing_of<Shape>(context, id_of(slot, generation));
  const Shape* child = thing_of<Shape>(context, id_of(child_slot, child_generation));
  if (shape == nullptr || child == nullptr) return kGone;
  context.world->undo().keep(*shape);
  const Result<void> done = shape->add_child(*child, pose_at(pose));
  return done ? kOk : context.refuse(done.error());
}

void mesh_clear(void* c) { context_of(c).mesh_points.clear(); }

void mesh_point(void* c, double x, double y, double z) { context_of(c).mesh_points.emplace_back(x, y, z); }

std::int32_t add_mesh_shape(void* c, const char* name, std::int32_t length, const char* file, std::int32_t file_length,
                            double sx, double sy, double sz, std::int32_t max_vertices) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRefused;
  const Vec3 scale(sx, sy, sz);
  ShapeModel model;
  model.kind = ShapeKind::mesh;
  if (file_length > 0) {
    const auto mesh = mesh_of_file(context, text_of(file, file_length), scale, max_vertices);
    if (!mesh) return context.refuse(mesh.error());
    model.mesh = *mesh;
  } else {
    std::vector<Vec3> points = context.mesh_points;
    if (context.answer.top_level == 0 && points.size() > kMostPoints) {
      return context.refuse(
          fmt::format("a convex mesh of {} points takes long; in a callback up to {}, more at the top level",
                      points.size(), kMostPoints));
    }
    for (Vec3& point : points) point *= scale;
    model.mesh = mesh_of_points(std::move(points), std::string(text_of(name, length)), max_vertices, 0);
  }
  return made(context, context.world->add_shape(std::string(text_of(name, length)), std::move(model)));
}

void urdf_clear(void* c) {
  ScriptContext& context = context_of(c);
  context.import = {};
  context.import.package_paths = context.options.package_paths;
  context.build = {};
}

void urdf_flag(void* c, std::int32_t which, std::int32_t on) {
  ScriptContext& context = context_of(c);
  if (which == 0) context.import.fixed_base = on != 0;
  if (which == 1) context.import.keep_fixed = on != 0;
  if (which == 2) context.build.servo_motors = on != 0;
}

void urdf_pose(void* c, const char* joint, std::int32_t length, double value) {
  context_of(c).import.pose[std::string(text_of(joint, length))] = value;
}

void urdf_package_path(void* c, const char* path, std::int32_t length) {
  context_of(c).import.package_paths.emplace_back(text_of(path, length));
}

std::int32_t load_urdf(void* c, const char* path, std::int32_t path_length, const char* name, std::int32_t length,
                       const double* pose) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRefused;
  const auto model = model_of_file(context, text_of(path, path_length));
  if (!model) return context.refuse(model.error());
  place(context.build, pose);
  const std::string body_name = length > 0 ? std::string(text_of(name, length)) : (*model)->name;
  const Result<Body*> body = context.world->add_body(*model, body_name, context.build);
  if (body) say_place(context, (*body)->id(), context.build);
  return made(context, body);
}

}  // namespace limber::calls
