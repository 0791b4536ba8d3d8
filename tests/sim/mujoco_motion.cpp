// Runs a model in both programs; bodies have the same names in both.
#include "mujoco_motion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "model/import.h"
#include "sim/world/part.h"
#include "stage.h"

namespace limber::sim::test {

namespace {

constexpr double kMotionStep = 0.0005;
constexpr int kMotionSteps = 1000;
constexpr int kStepsBetweenComparisons = 50;
constexpr int kFineSteps = 10;            // MuJoCo's own steps in one
constexpr double kStartOffset = 0.2;      // rad or m
constexpr double kMaxOwnChange = 1.3e-3;  // m

using MujocoModel = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using MujocoData = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

// Leaves gravity, and the springs of tendons.
void leave_gravity(mjModel& m, bool with_tendons) {
  m.opt.timestep = kMotionStep;
  m.opt.integrator = mjINT_EULER;
  m.opt.disableflags |= mjDSBL_CONTACT | mjDSBL_ACTUATION | mjDSBL_FRICTIONLOSS | mjDSBL_LIMIT | mjDSBL_EQUALITY;
  if (!with_tendons) m.opt.disableflags |= mjDSBL_PASSIVE;
  std::fill(m.jnt_stiffness, m.jnt_stiffness + m.njnt, 0.0);
  std::fill(m.dof_armature, m.dof_armature + m.nv, 0.0);
  std::fill(m.dof_damping, m.dof_damping + m.nv, 0.0);  // its integrator adds it to the inertia in any case
  if ((m.opt.disableflags & mjDSBL_GRAVITY) != 0) std::fill(m.opt.gravity, m.opt.gravity + 3, 0.0);
}

void leave_gravity(model::BodyModel& model, bool with_tendons) {
  model.loops.clear();
  if (!with_tendons) model.tendons.clear();
  for (model::LinkModel& link : model.links) link.collisions.clear();
  for (model::JointModel& joint : model.joints) {
    joint.limited = false;
    joint.damping = joint.friction = joint.armature = joint.spring.stiffness = 0;
    joint.ball = {};
    joint.mimic = -1;
  }
}

bool has_value(const mjModel& m, int joint) {
  return m.jnt_type[joint] == mjJNT_HINGE || m.jnt_type[joint] == mjJNT_SLIDE;
}

/// The bodies of a file, as parts of a world.
struct Copy {
  WorldFixture fixture;
  bool with_tendons = false;
  std::vector<std::pair<int, const Part*>> parts;  ///< MuJoCo's index of a body, and its part.

  /// Adds the tree of a top-level body, and sets MuJoCo's start pose to that of the tree; returns the reason if this
  /// fails.
  std::string add_tree(const std::string& path, const mjModel& m, mjData& d, int top) {
    model::ImportOptions options;
    options.root = mj_id2name(&m, mjOBJ_BODY, top);
    for (int i = 0; i < m.njnt; ++i) {
      const char* const name = mj_id2name(&m, mjOBJ_JOINT, i);
      if (name != nullptr && has_value(m, i) && m.body_rootid[m.jnt_bodyid[i]] == top)
        options.pose[name] = kStartOffset;
    }
    const auto imported = model::import_model(path, options);
    if (!imported) return imported.error();
    auto model = std::make_shared<model::BodyModel>(**imported);
    double mass = 0;
    for (const model::FileLink& link : model->file_links) mass += link.mass;
    // MuJoCo 2 integrates meshes in its own way
    if (std::abs(mass - m.body_subtreemass[top]) > 1e-3 * m.body_subtreemass[top])
      return fmt::format("'{}' has a mass of {:.6g} kg, not {:.6g} kg", options.root, mass, m.body_subtreemass[top]);
    set_start(*model, m, d, top);
    leave_gravity(*model, with_tendons);
    BuildOptions build;
    build.servo_motors = false;
    const Result<Body*> body = fixture.world.add_body(model, options.root, build);
    if (!body) return body.error();
    for (int i = top; i < m.nbody; ++i) {
      const char* const name = mj_id2name(&m, mjOBJ_BODY, i);
      if (m.body_rootid[i] != top || name == nullptr) continue;
      if (const Part* const part = (*body)->find_part(name)) parts.emplace_back(i, part);
    }
    return {};
  }

  static void set_start(const model::BodyModel& model, const mjModel& m, mjData& d, int top) {
    for (const model::JointModel& joint : model.joints) {
      const int i = mj_name2id(&m, mjOBJ_JOINT, joint.name.c_str());
      if (i < 0 || !has_value(m, i)) continue;
      const int at = m.jnt_qposadr[i];
      d.qpos[at] = m.qpos0[at] + joint.start;
    }
    const int first = m.body_jntadr[top];
    if (first < 0 || m.jnt_type[first] != mjJNT_FREE) return;
    double* const q = d.qpos + m.jnt_qposadr[first];
    const Pose& start = model.links.front().start;
    put(q, start.position);
    q[3] = start.rotation.w;
    put(q + 4, Vec3(start.rotation.x, start.rotation.y, start.rotation.z));
  }
};

void compare(const mjModel& m, const mjData& d, const Copy& copy, MotionComparison& out) {
  for (const auto& [i, part] : copy.parts) {
    const double difference = glm::length(part->pose().position - vec3_at(d.xpos + 3 * i));
    if (!(difference > out.difference)) continue;
    out.difference = difference;
    out.body = mj_id2name(&m, mjOBJ_BODY, i);
  }
}

double largest_distance(const mjModel& m, const double* a, const double* b) {
  double largest = 0;
  for (int i = 0; i < m.nbody; ++i) largest = std::max(largest, glm::length(vec3_at(a + 3 * i) - vec3_at(b + 3 * i)));
  return largest;
}

void run(mjModel& m, mjData& d, mjData& fine, Copy& copy, MotionComparison& out) {
  mj_kinematics(&m, &d);
  const std::vector<double> start(d.xpos, d.xpos + 3 * m.nbody);
  for (int step = 1; step <= kMotionSteps; ++step) {
    mj_step(&m, &d);
    m.opt.timestep = kMotionStep / kFineSteps;
    for (int i = 0; i < kFineSteps; ++i) mj_step(&m, &fine);
    m.opt.timestep = kMotionStep;
    copy.fixture.world.step();
    if (step % kStepsBetweenComparisons != 0) continue;
    mj_kinematics(&m, &d);
    mj_kinematics(&m, &fine);
    if (largest_distance(m, d.xpos, fine.xpos) > kMaxOwnChange) return;
    compare(m, d, copy, out);
    out.distance = std::max(out.distance, largest_distance(m, d.xpos, start.data()));
    out.end = step * kMotionStep;
  }
}

}  // namespace

MotionComparison compare_motion_with_mujoco(const std::string& path, bool with_tendons) {
  MotionComparison out;
  char error[1000] = "";
  const MujocoModel m(mj_loadXML(path.c_str(), nullptr, error, sizeof error), mj_deleteModel);
  if (m == nullptr) {
    out.left_out = *error != '\0' ? error : "it can't be read";
    return out;
  }
  leave_gravity(*m, with_tendons);
  const MujocoData d(mj_makeData(m.get()), mj_deleteData);
  Copy copy;
  copy.with_tendons = with_tendons;
  copy.fixture.set(copy.fixture.world.id(), "gravity", {m->opt.gravity[0], m->opt.gravity[1], m->opt.gravity[2]});
  copy.fixture.set(copy.fixture.world.id(), "timestep", {kMotionStep});
  copy.fixture.set(copy.fixture.world.id(), "substeps", {1});
  for (int i = 1; i < m->nbody; ++i) {
    if (m->body_parentid[i] != 0 || mj_id2name(m.get(), mjOBJ_BODY, i) == nullptr) continue;
    out.left_out = copy.add_tree(path, *m, *d, i);
    if (!out.left_out.empty()) return out;
  }
  if (copy.parts.empty()) {
    out.left_out = "it has no named body";
    return out;
  }
  const MujocoData fine(mj_copyData(nullptr, m.get(), d.get()), mj_deleteData);
  run(*m, *d, *fine, copy, out);
  return out;
}

}  // namespace limber::sim::test
