// Picks parts by rays and converts drags and clicks to messages.
#include "app/view/viewport_mouse.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace limber::app {

namespace {

double ndc_x(const ViewState& view, double x) { return 2 * x / view.width - 1; }
double ndc_y(const ViewState& view, double y) { return 1 - 2 * y / view.height; }

// returns the node of the part with transient values at `part_offset`; 0: none
std::uint32_t node_of(const TreeSnapshot& tree, std::uint32_t part_offset) {
  for (std::uint32_t node = 0; node < tree.nodes().size(); node++) {
    const TreeSnapshot::Node& n = tree.nodes()[node];
    if (n.transient == part_offset && n.table->name() == "part") return node;
  }
  return 0;
}

double mass_of(const engine::ValueSnapshot& values, std::uint32_t node) {
  const Property* const property = values.tree->nodes()[node].table->find("mass");
  const double* const mass =
      property == nullptr ? nullptr : values.value(values.tree->location({node, property})).numbers;
  return mass == nullptr ? 1 : mass[0];
}

Vec3 grabbed_point(const ViewState& view, std::uint32_t part_offset, const Vec3& point) {
  const Pose pose = engine::part_pose(view.now, part_offset);
  return pose.position + pose.rotation * point;
}

}  // namespace

void ViewportMouse::event(const panel::InputEvent& event, const ViewState& view) {
  if (event.kind == panel::InputEvent::Kind::move) {
    x_ = event.x;
    y_ = event.y;
    if (grab_ && std::hypot(x_ - grab_->x, y_ - grab_->y) > kClickTolerance) grab_->moved = true;
  }
  if (event.kind != panel::InputEvent::Kind::button || event.button != 0) return;
  if (event.down) {
    press(event, view);
  } else {
    release(view);
  }
}

void ViewportMouse::press(const panel::InputEvent& event, const ViewState& view) {
  grab_.reset();
  if (event.mods.shift || event.mods.alt) return;  // reserved for camera movement
  const std::optional<render::Picked> picked = render::pick(view.now, view.camera, ndc_x(view, x_), ndc_y(view, y_));
  const std::uint32_t node = picked ? node_of(view.tree(), picked->part_offset) : 0;
  if (node == 0) return;
  const std::uint32_t body = view.tree().nodes()[view.tree().nodes()[node].parent].parent;
  const Vec3 along = render::ray_through(view.camera, ndc_x(view, x_), ndc_y(view, y_));
  const std::string path = view.tree().path(node);
  if (event.mods.ctrl) {
    Message push{path + "/apply_impulse", {}};
    for (const Vec3& v : {mass_of(view.values, node) * kPushSpeed * along, picked->point})
      for (int i = 0; i < 3; i++) push.args.push_back(Arg::of(v[i]));
    messages_.push_back(std::move(push));
    return;
  }
  const Pose pose = engine::part_pose(view.now, picked->part_offset);
  grab_ = Grab{picked->part_offset,
               std::string(view.tree().name(body)),
               std::string(view.tree().name(node)),
               path,
               glm::conjugate(pose.rotation) * (picked->point - pose.position),
               glm::dot(picked->point - view.camera.eye, view.camera.forward),
               x_,
               y_,
               false};
}

void ViewportMouse::release(const ViewState& view) {
  if (!grab_) {
    last_path_.clear();
    return;
  }
  const Grab grab = *std::exchange(grab_, std::nullopt);
  if (grab.moved) {
    messages_.push_back(
        {"/physics/part/release", {Arg::of(std::string_view(grab.body)), Arg::of(std::string_view(grab.part))}});
    return;
  }
  selected_ = grab.path;
  const bool double_click = last_path_ == grab.path && view.clock - last_click_ < kDoubleClickTime;
  if (double_click) followed_ = grab.part_offset;
  last_path_ = double_click ? "" : grab.path;
  last_click_ = view.clock;
}

// the mouse position projected to the plane through the grabbed point, parallel to the view plane
Vec3 ViewportMouse::target(const ViewState& view) const {
  const Vec3 along = render::ray_through(view.camera, ndc_x(view, x_), ndc_y(view, y_));
  return view.camera.eye + along * (grab_->depth / std::max(glm::dot(along, view.camera.forward), 0.05));
}

void ViewportMouse::frame(const ViewState& view) {
  if (!grab_ || !grab_->moved) return;
  if (grab_->part_offset >= view.now.transient.size()) return grab_.reset();
  const Vec3 to = target(view);
  Message hold{"/physics/part/hold", {Arg::of(std::string_view(grab_->body)), Arg::of(std::string_view(grab_->part))}};
  for (const Vec3& v : {grab_->point, to})
    for (int i = 0; i < 3; i++) hold.args.push_back(Arg::of(v[i]));
  messages_.push_back(std::move(hold));
}

std::optional<panel::SpringMarker> ViewportMouse::spring_marker(const ViewState& view) const {
  if (!grab_ || !grab_->moved || grab_->part_offset >= view.now.transient.size()) return std::nullopt;
  const glm::vec4 clip = view.camera.projection * view.camera.view *
                         glm::vec4(glm::vec3(grabbed_point(view, grab_->part_offset, grab_->point)), 1);
  if (clip.w <= 0) return std::nullopt;
  return panel::SpringMarker{(static_cast<double>(clip.x / clip.w) + 1) / 2 * view.width,
                             (1 - static_cast<double>(clip.y / clip.w)) / 2 * view.height, x_, y_,
                             fmt::format("{}  {}", grab_->body, grab_->part)};
}

}  // namespace limber::app
