// From pieces and poses to instances, batch by batch.
#include "view/draw_list.h"

#include <algorithm>
#include <cmath>

#include "base/color.h"

namespace limber {

namespace {

constexpr float kUnseen = 0.002F;  // of alpha: what is clearer is not drawn
constexpr float kCasts = 0.5F;     // and casts no shadow
constexpr std::size_t kMeasured = 2000;

float real(double v) { return static_cast<float>(v); }
glm::vec3 real(const Vec3& v) { return {real(v.x), real(v.y), real(v.z)}; }

double reach_of(const ShapeModel& shape) {
  double far = 0;
  if (shape.mesh != nullptr) {
    for (const Vec3& v : shape.mesh->vertices) far = std::max(far, glm::length(shape.mesh_pose * v));
    return far;
  }
  const double half = shape.height / 2;
  switch (shape.kind) {
    case ShapeKind::box:
      return glm::length(shape.size) / 2;
    case ShapeKind::sphere:
      return shape.radius;
    case ShapeKind::capsule:
      return shape.radius + half;
    default:
      return std::hypot(shape.radius, half);
  }
}

// the seed's scales are 0.5 for a surface that shines as it should; its highlights are Phong's
Instance paint_of(const Material& m) {
  Instance out{};
  const Vec3 diffuse = rgb_of(m.diffuse_color);
  const Vec3 ambient = rgb_of(m.ambient_color);
  for (int i = 0; i < 3; i++) {
    out.diffuse[i] = real(2 * m.diffuse_scale * light_of(diffuse[i]));
    out.ambient[i] = real(2 * m.ambient_scale * light_of(ambient[i]));
  }
  out.alpha = real(1 - m.transparency);
  out.specular = real(m.specular_scale);
  out.power = real(10 + 4 * m.specular_pow);
  return out;
}

Pose between(const double* a, const double* b, double mix, const LiveOffsets& at) {
  const Vec3 p = vec3_at(b + at.part_position);
  const Quat q = quat_at(b + at.part_rotation);
  if (mix >= 1) return {p, q};
  const Quat from = quat_at(a + at.part_rotation);
  const Quat to = glm::dot(from, q) < 0 ? -q : q;
  return {glm::mix(vec3_at(a + at.part_position), p, mix), glm::normalize(from * (1 - mix) + to * mix)};
}

}  // namespace

void DrawList::learn(const Snapshot& now) {
  drawing_ = now.drawing;
  meshes_.clear();
  forms_.clear();
  models_.clear();
  std::map<MeshKey, std::uint32_t> numbers;
  for (const DrawnForm& drawn : drawing_->forms) {
    const ShapeModel& shape = drawn.shape;
    Form form;
    form.material = drawn.material;
    form.normal = shape.normal;
    form.reach = reach_of(shape);
    form.mesh = {shape.kind, nullptr};
    if (shape.mesh != nullptr) {
      form.mesh = {ShapeKind::mesh, shape.mesh.get()};
      form.offset = shape.mesh_pose;
      models_[shape.mesh.get()] = shape.mesh;
    }
    const MeshSize size = shape.mesh != nullptr ? MeshSize{} : mesh_size(shape);
    for (int i = 0; i < 3; i++) form.size.extent[i] = real(size.extent[i]);
    form.size.round = real(size.round);
    const auto [number, fresh] = numbers.try_emplace(form.mesh, static_cast<std::uint32_t>(meshes_.size()));
    if (fresh) meshes_.push_back(form.mesh);
    form.mesh_number = number->second;
    forms_.push_back(form);
  }
}

void DrawList::paint(const Snapshot& now) {
  painted_ = now.visuals_version;
  std::uint32_t most = 0;
  for (const Form& form : forms_) most = std::max(most, form.material);
  paints_.clear();
  for (std::uint32_t i = 0; i <= most; i++) paints_.push_back(paint_of(material_of(now, i)));
}

void DrawList::see(const Form& form, const Pose& pose, const DrawEye& eye) {
  const Instance& paint = paints_[form.material];
  if (paint.alpha < kUnseen || !is_finite(pose.position) || !is_finite(pose.rotation)) return;
  if (form.mesh.kind == ShapeKind::plane) {
    planes_.push_back({real(pose.position),
                       real(pose.rotation * form.normal),
                       {paint.diffuse[0], paint.diffuse[1], paint.diffuse[2]},
                       paint.alpha});
    return;
  }
  const Pose at = pose * form.offset;
  Instance instance = paint;
  const glm::vec3 place = real(at.position);
  for (int i = 0; i < 3; i++) {
    instance.place[i] = place[i];
    instance.extent[i] = form.size.extent[i];
  }
  instance.round = form.size.round;
  instance.turn[0] = real(at.rotation.x);
  instance.turn[1] = real(at.rotation.y);
  instance.turn[2] = real(at.rotation.z);
  instance.turn[3] = real(at.rotation.w);
  const double depth = glm::dot(at.position - eye.at, eye.forward);
  const double pixels = form.reach * eye.pixels / std::max(depth, 0.1);
  const int detail = std::min(kDetails - 1, (pixels > 40 ? 0 : pixels > 12 ? 1 : pixels > 4 ? 2 : 3) + eye.coarser);
  const auto key = form.mesh_number * kDetails + static_cast<std::uint32_t>(detail);
  (paint.alpha < 1 ? glassy_ : solid_).push_back({instance, key, real(depth)});
  places_.push_back(place);
  reaches_.push_back(real(form.reach));
}

void DrawList::gather(const Snapshot& before, const Snapshot& now, double mix, const DrawEye& eye) {
  if (drawing_ != now.drawing) {
    learn(now);
    paint(now);
  } else if (painted_ != now.visuals_version) {
    paint(now);
  }
  const bool mixes = before.drawing == now.drawing && before.live.size() == now.live.size();
  const LiveOffsets& at = live_offsets();
  solid_.clear();
  glassy_.clear();
  planes_.clear();
  places_.clear();
  reaches_.clear();
  for (const DrawnPiece& piece : drawing_->pieces) {
    if (now.live[piece.enabled_at] == 0) continue;
    const double* const to = now.live.data() + piece.part_at;
    const Pose part = between(mixes ? before.live.data() + piece.part_at : to, to, mixes ? mix : 1, at);
    see(forms_[piece.form], part * piece.origin, eye);
  }
  measure();
  put_together();
}

// the middle of what stands between the outer tenths along each axis, and the distance that nine of ten don't reach:
// one of many that falls for ever moves neither; of a few each counts, of thousands some speak for all
void DrawList::measure() {
  center_ = glm::vec3(0);
  radius_ = 1;
  if (places_.empty()) return;
  const std::size_t stride = (places_.size() + kMeasured - 1) / kMeasured;
  const auto fill = [&](auto&& number) {
    numbers_.clear();
    for (std::size_t i = 0; i < places_.size(); i += stride) numbers_.push_back(number(i));
  };
  const auto ranked = [&](double rank) {
    std::nth_element(numbers_.begin(), numbers_.begin() + static_cast<std::ptrdiff_t>(rank), numbers_.end());
    return numbers_[static_cast<std::size_t>(rank)];
  };
  const auto last = static_cast<double>((places_.size() - 1) / stride);
  for (int axis = 0; axis < 3; axis++) {
    fill([&](std::size_t i) { return places_[i][axis]; });
    const float low = ranked(std::floor(0.1 * last));
    center_[axis] = (low + ranked(std::ceil(0.9 * last))) / 2;
  }
  fill([&](std::size_t i) { return glm::distance(places_[i], center_) + reaches_[i]; });
  radius_ = ranked(std::ceil(0.9 * last));
}

// by mesh and detail, else in their order
void DrawList::order_solid() {
  first_.assign(meshes_.size() * kDetails + 1, 0);
  for (const Seen& s : solid_) first_[s.key + 1]++;
  for (std::size_t k = 1; k < first_.size(); k++) first_[k] += first_[k - 1];
  order_.resize(solid_.size());
  for (std::size_t i = 0; i < solid_.size(); i++) order_[first_[solid_[i].key]++] = static_cast<std::uint32_t>(i);
}

void DrawList::order_glassy() {
  order_.resize(glassy_.size());
  for (std::size_t i = 0; i < order_.size(); i++) order_[i] = static_cast<std::uint32_t>(i);
  std::stable_sort(order_.begin(), order_.end(),
                   [this](std::uint32_t a, std::uint32_t b) { return glassy_[a].depth > glassy_[b].depth; });
}

void DrawList::add_in_order(std::vector<Batch>& batches, const std::vector<Seen>& seen) {
  batches.clear();
  std::uint32_t last = 0;
  for (const std::uint32_t i : order_) {
    const Seen& s = seen[i];
    const bool casts = s.instance.alpha >= kCasts;
    if (batches.empty() || s.key != last || batches.back().casts != casts) {
      batches.push_back({meshes_[s.key / kDetails], static_cast<int>(s.key % kDetails),
                         static_cast<std::uint32_t>(instances_.size()), 0, casts});
      last = s.key;
    }
    instances_.push_back(s.instance);
    batches.back().count++;
  }
}

void DrawList::put_together() {
  instances_.clear();
  order_solid();
  add_in_order(opaque_, solid_);
  order_glassy();
  add_in_order(clear_, glassy_);
}

}  // namespace limber
