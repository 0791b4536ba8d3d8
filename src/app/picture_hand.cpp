// Rays, springs' ends, clicks.
#include "app/picture_hand.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace limber {

namespace {

double right_of(const HandView& view, double x) { return 2 * x / view.width - 1; }
double up_of(const HandView& view, double y) { return 1 - 2 * y / view.height; }

// the part whose numbers begin there; 0: none
std::uint32_t node_of(const Tree& tree, std::uint32_t part_at) {
  for (std::uint32_t node = 0; node < tree.nodes().size(); node++) {
    const Tree::Node& n = tree.nodes()[node];
    if (n.live == part_at && n.table->name() == "part") return node;
  }
  return 0;
}

double mass_of(const Image& image, std::uint32_t node) {
  const Row* const row = image.tree->nodes()[node].table->find("mass");
  const double* const mass = row == nullptr ? nullptr : image.value(image.tree->numbers({node, row})).numbers;
  return mass == nullptr ? 1 : mass[0];
}

Vec3 held_point(const HandView& view, std::uint32_t part_at, const Vec3& point) {
  const Pose pose = part_pose(view.now, part_at);
  return pose.position + pose.rotation * point;
}

}  // namespace

void PictureHand::event(const InputEvent& event, const HandView& view) {
  if (event.kind == InputEvent::Kind::move) {
    x_ = event.x;
    y_ = event.y;
    if (held_ && std::hypot(x_ - held_->x, y_ - held_->y) > kStill) held_->moved = true;
  }
  if (event.kind != InputEvent::Kind::button || event.button != 0) return;
  if (event.down) {
    press(event, view);
  } else {
    release(view);
  }
}

void PictureHand::press(const InputEvent& event, const HandView& view) {
  held_.reset();
  if (event.mods.shift || event.mods.alt) return;  // the view's
  const std::optional<Picked> picked = pick(view.now, view.lens, right_of(view, x_), up_of(view, y_));
  const std::uint32_t node = picked ? node_of(view.tree(), picked->part_at) : 0;
  if (node == 0) return;
  const std::uint32_t body = view.tree().nodes()[view.tree().nodes()[node].parent].parent;
  const Vec3 along = ray_through(view.lens, right_of(view, x_), up_of(view, y_));
  const std::string path = view.tree().path(node);
  if (event.mods.ctrl) {
    Message push{path + "/apply_impulse", {}};
    for (const Vec3& v : {mass_of(view.image, node) * kPushSpeed * along, picked->point})
      for (int i = 0; i < 3; i++) push.args.push_back(Arg::of(v[i]));
    messages_.push_back(std::move(push));
    return;
  }
  const Pose pose = part_pose(view.now, picked->part_at);
  held_ = Held{picked->part_at,
               std::string(view.tree().name(body)),
               std::string(view.tree().name(node)),
               path,
               glm::conjugate(pose.rotation) * (picked->point - pose.position),
               glm::dot(picked->point - view.lens.eye, view.lens.forward),
               x_,
               y_,
               false};
}

void PictureHand::release(const HandView& view) {
  if (!held_) {
    last_path_.clear();
    return;
  }
  const Held held = *std::exchange(held_, std::nullopt);
  if (held.moved) {
    messages_.push_back(
        {"/physics/part/release", {Arg::of(std::string_view(held.body)), Arg::of(std::string_view(held.part))}});
    return;
  }
  chosen_ = held.path;
  const bool twice = last_path_ == held.path && view.clock - last_click_ < kTwice;
  if (twice) followed_ = held.part_at;
  last_path_ = twice ? "" : held.path;
  last_click_ = view.clock;
}

// on the plane through what is held, across the view
Vec3 PictureHand::target(const HandView& view) const {
  const Vec3 along = ray_through(view.lens, right_of(view, x_), up_of(view, y_));
  return view.lens.eye + along * (held_->depth / std::max(glm::dot(along, view.lens.forward), 0.05));
}

void PictureHand::frame(const HandView& view) {
  if (!held_ || !held_->moved) return;
  if (held_->part_at >= view.now.live.size()) return held_.reset();
  const Vec3 to = target(view);
  Message hold{"/physics/part/hold", {Arg::of(std::string_view(held_->body)), Arg::of(std::string_view(held_->part))}};
  for (const Vec3& v : {held_->point, to})
    for (int i = 0; i < 3; i++) hold.args.push_back(Arg::of(v[i]));
  messages_.push_back(std::move(hold));
}

std::optional<PictureHand::Mark> PictureHand::mark(const HandView& view) const {
  if (!held_ || !held_->moved || held_->part_at >= view.now.live.size()) return std::nullopt;
  const glm::vec4 clip =
      view.lens.projection * view.lens.view * glm::vec4(glm::vec3(held_point(view, held_->part_at, held_->point)), 1);
  if (clip.w <= 0) return std::nullopt;
  return Mark{(static_cast<double>(clip.x / clip.w) + 1) / 2 * view.width,
              (1 - static_cast<double>(clip.y / clip.w)) / 2 * view.height, x_, y_,
              fmt::format("{}  {}", held_->body, held_->part)};
}

}  // namespace limber
