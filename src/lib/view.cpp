// View: the snapshot of the present state is drawn as in `limber --screenshot`.
#include "lib/view.h"

#include <atomic>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/system/process.h"
#include "sim/visuals/visuals.h"

namespace limber::lib {

namespace {

constexpr int kMaxSide = 16384;
constexpr double kMaxCoordinate = 1e6;  // m, as the camera's properties
constexpr double kMinFovy = 1;          // degrees
constexpr double kMaxFovy = 170;

bool valid_point(const double* point) {
  if (point == nullptr) return true;
  for (int i = 0; i < 3; i++) {
    if (!(std::abs(point[i]) <= kMaxCoordinate)) return false;
  }
  return true;
}

// Drivers have threads, which a child process lacks. Returns false in a child whose ancestor has drawn an image.
bool may_use_driver() {
  static std::atomic<std::int64_t> first{-1};  // the fork count when the first image was drawn
  std::int64_t none = -1;
  const auto forks = static_cast<std::int64_t>(system::fork_count());
  return first.compare_exchange_strong(none, forks) || none == forks;
}

render::Quality render_quality(limber_quality quality) {
  switch (quality) {
    case LIMBER_QUALITY_LOW:
      return render::Quality::low;
    case LIMBER_QUALITY_MEDIUM:
      return render::Quality::medium;
    case LIMBER_QUALITY_HIGH:
      break;
  }
  return render::Quality::high;
}

Vec3 eye_of(engine::Engine& engine, const limber_image& image) {
  return image.position == nullptr ? engine.world().visuals().camera().eye() : vec3_at(image.position);
}
Vec3 target_of(engine::Engine& engine, const limber_image& image) {
  return image.target == nullptr ? engine.world().visuals().camera().target() : vec3_at(image.target);
}

Result<void> check_camera(engine::Engine& engine, const limber_image& image) {
  if (!valid_point(image.position) || !valid_point(image.target))
    return Error{"image: position and target must be finite and at most 1e6 m from the origin"};
  if ((image.position != nullptr || image.target != nullptr) && eye_of(engine, image) == target_of(engine, image))
    return Error{"image: position and target of the camera are the same point; move one of them"};
  if (image.fovy != 0 && !(image.fovy >= kMinFovy && image.fovy <= kMaxFovy))
    return Error{fmt::format("image: fovy must be {} to {} degrees, or 0 for that of the scene, got {}", kMinFovy,
                             kMaxFovy, image.fovy)};
  return {};
}

engine::CameraSettings camera_of(engine::Engine& engine, const engine::Snapshot& snapshot, const limber_image& image) {
  engine::CameraSettings camera = engine::camera_of(snapshot);
  if (image.fovy != 0) camera.fovy = image.fovy;
  if (image.position == nullptr && image.target == nullptr) return camera;
  const sim::CameraView view = sim::view_from_to(eye_of(engine, image), target_of(engine, image));
  camera.position = view.position;
  camera.rotation = view.rotation;
  camera.distance = view.distance;
  return camera;
}

}  // namespace

Result<void> check_image(engine::Engine& engine, const limber_image& image, std::size_t size) {
  if (image.size != sizeof(limber_image)) return Error{"image: begin with LIMBER_IMAGE, which sets its size"};
  if (image.width < 1 || image.width > kMaxSide || image.height < 1 || image.height > kMaxSide)
    return Error{
        fmt::format("image: width and height must be 1 to {}, got {} and {}", kMaxSide, image.width, image.height)};
  const std::size_t bytes = 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (size != bytes) return Error{fmt::format("the array of the image must have {} bytes, got {}", bytes, size)};
  if (Result<void> camera = check_camera(engine, image); !camera) return camera;
  int quality = 0;  // may be none of the enumeration
  static_assert(sizeof quality == sizeof image.quality);
  std::memcpy(&quality, &image.quality, sizeof quality);
  if (quality < LIMBER_QUALITY_HIGH || quality > LIMBER_QUALITY_LOW)
    return Error{fmt::format("image: quality must be 0 to {}, got {}", static_cast<int>(LIMBER_QUALITY_LOW), quality)};
  return {};
}

View::~View() {
  if (context_ == nullptr) return;
  const render::CurrentContextGuard guard;
  (void)context_->make_current();
  renderer_ = nullptr;
  context_ = nullptr;
}

Result<void> View::open(limber_quality quality) {
  if (!may_use_driver())
    return Error{
        "a process that has drawn images was forked; draw the first image after the fork, or start the process afresh"};
  if (context_ != nullptr && !context_->make_current())
    return Error{"the OpenGL driver rejects the context; is another one (GLX) current on this thread?"};
  if (context_ == nullptr) {
    Result<std::unique_ptr<render::OffscreenContext>> context = render::OffscreenContext::make();
    if (!context) return Error{context.error()};
    context_ = std::move(*context);
  }
  if (renderer_ != nullptr && quality == quality_) return {};
  renderer_ = nullptr;
  Result<std::unique_ptr<render::Renderer>> renderer =
      render::Renderer::make(context_->api(), "", render_quality(quality));
  if (!renderer) return Error{renderer.error()};
  renderer_ = std::move(*renderer);
  quality_ = quality;
  return {};
}

// The engine's own snapshot is that of the last pass. Values may have been set, or a state restored, since.
const engine::Snapshot& View::snapshot(engine::Engine& engine) {
  if (!publisher_ || runs_ != engine.history().clears()) {
    publisher_.emplace(engine.world(), snapshots_);
    runs_ = engine.history().clears();
  }
  publisher_->publish(false, 1);
  snapshot_ = snapshots_.read();
  return *snapshot_;
}

Result<void> View::draw(engine::Engine& engine, const limber_image& image, std::uint8_t* pixels) {
  const engine::Snapshot& current = snapshot(engine);
  const engine::CameraSettings camera = camera_of(engine, current, image);
  const render::CurrentContextGuard guard;
  if (Result<void> opened = open(image.quality); !opened) return opened;
  if (Result<void> drawn = renderer_->draw_from(current, camera, image.width, image.height); !drawn) return drawn;
  const render::Pixels drawn = renderer_->read();
  const std::size_t count = drawn.bytes.size() / 4;
  for (std::size_t i = 0; i < count; i++) std::memcpy(pixels + 3 * i, drawn.bytes.data() + 4 * i, 3);
  return {};
}

}  // namespace limber::lib
