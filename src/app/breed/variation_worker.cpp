// The loop of the child process, its run and its images.
#include "app/breed/variation_worker.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include "app/breed/variation_protocol.h"
#include "app/exit_code.h"
#include "app/experiments/evaluator.h"
#include "app/experiments/input_lines.h"
#include "app/paths.h"
#include "app/show/engine_thread.h"
#include "app/view/camera_control.h"
#include "app/view/snapshot_interpolation.h"
#include "base/log/output.h"
#include "base/system/clock.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/system/signals.h"
#include "base/system/standard_output.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "engine/engine.h"
#include "ui/render/offscreen.h"
#include "ui/render/renderer.h"

namespace limber::app {

namespace {

using experiments::Evaluation;
using experiments::WorkerSetup;

/// One run of the scene, on a thread of its own.
class VariationRun {
 public:
  explicit VariationRun(engine::EngineOptions options) : engine_(link_, std::move(options)), thread_(engine_) {
    thread_.allow_ticks(false);
  }

  void send(std::vector<Message> messages) {
    link_.command_queue.push({std::move(messages), CommandOrigin{CommandSource::panel, 0, 0, false}});
    link_.wake_engine();
  }
  void pause(bool paused) {
    if (std::exchange(paused_, paused) != paused) send({{paused ? "/transport/pause" : "/transport/play", {}}});
  }
  /// Returns the reason why it doesn't play as it should; empty: it does.
  std::string error() {
    if (!thread_.started()) return {};
    if (!thread_.result()) return thread_.result().error();
    if (std::string error = script_error(link_); error_.empty() && !error.empty()) error_ = std::move(error);
    if (!error_.empty()) return error_;
    return link_.health.count(engine::HealthItem::bodies) > 0 ? "a body became unstable" : "";
  }
  std::shared_ptr<const engine::Snapshot> snapshot() { return link_.snapshots.read(); }

 private:
  engine::EngineLink link_;
  engine::Engine engine_;
  EngineThread thread_;
  bool paused_ = false;
  std::string error_;  // the first error of its script
};

class VariationPlayer {
 public:
  /// Opens the renderer. The error says why there are no images.
  Result<void> open(const DisplayOptions& display);
  void set_up(WorkerSetup setup) {
    setup_ = std::move(setup);
    read_scene();
  }
  void play(const Evaluation& evaluation);
  /// Returns the header, and draws the image.
  ImageHeader draw(const ImageRequest& request, render::Pixels& image);

 private:
  void read_scene();
  void move_camera(const MouseMovement& all, int height, double now);
  void follow(bool follows);

  std::unique_ptr<render::OffscreenContext> context_;
  std::unique_ptr<render::Renderer> renderer_;
  Evaluator evaluator_;
  WorkerSetup setup_;
  std::string setup_error_;
  std::uint64_t number_ = 0;
  std::unique_ptr<VariationRun> run_;
  SnapshotInterpolation snapshots_;
  CameraControl camera_;
  MouseMovement moved_;  // movement of the camera in this run
};

Result<void> VariationPlayer::open(const DisplayOptions& display) {
  Result<std::unique_ptr<render::OffscreenContext>> context = render::OffscreenContext::make(display.gl);
  if (!context) return Error{context.error()};
  context_ = std::move(*context);
  const bool slow = render::gl_is_software() || context_->api() != render::GlApi::core;
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::make(
      context_->api(), shader_dir(), render_quality(display, slow ? render::Quality::low : render::Quality::high));
  if (!renderer) return Error{renderer.error()};
  renderer_ = std::move(*renderer);
  return {};
}

void VariationPlayer::read_scene() {
  const Result<experiments::SceneInfo> scene = evaluator_.set_up(setup_);
  setup_error_ = scene ? "" : scene.error();
}

void VariationPlayer::play(const Evaluation& evaluation) {
  run_.reset();
  snapshots_ = {};
  camera_ = {};
  moved_ = {};
  number_ = evaluation.number;
  if (!setup_error_.empty()) read_scene();  // it may have been corrected
  if (setup_error_.empty()) run_ = std::make_unique<VariationRun>(evaluator_.options_to_play(evaluation));
}

void VariationPlayer::move_camera(const MouseMovement& all, int height, double now) {
  const MouseMovement last = std::exchange(moved_, all);
  const MouseMovement mouse{all.orbit_x - last.orbit_x, all.orbit_y - last.orbit_y, all.pan_x - last.pan_x,
                            all.pan_y - last.pan_y, all.wheel - last.wheel};
  if (mouse.any()) run_->send(camera_.move(mouse, engine::camera_of(snapshots_.current()), height, now));
}

void VariationPlayer::follow(bool follows) {
  const auto& bodies = snapshots_.current().body_list->bodies;
  const auto body = std::ranges::find_if(
      bodies, [](const engine::BodyEntry& each) { return !each.joint_offsets.empty() && !each.part_offsets.empty(); });
  if (!follows || body == bodies.end()) return camera_.stop_following();
  run_->send(camera_.follow(snapshots_.current(), body->part_offsets.front()));
}

ImageHeader VariationPlayer::draw(const ImageRequest& request, render::Pixels& image) {
  ImageHeader header;
  header.number = number_;
  header.error = setup_error_;
  if (run_ == nullptr) return header;
  run_->pause(request.paused);
  header.error = run_->error();
  const double now = system::clock_seconds();
  if (std::shared_ptr<const engine::Snapshot> newest = run_->snapshot()) snapshots_.add(std::move(newest), now);
  if (snapshots_.empty()) return header;
  move_camera(request.mouse, request.height, now);
  follow(request.follow);
  if (const Result<void> drawn = renderer_->draw(snapshots_.previous(), snapshots_.current(), snapshots_.mix(now),
                                                 request.width, request.height);
      !drawn) {
    header.error = drawn.error();
    return header;
  }
  image = renderer_->read();
  header.width = image.width;
  header.height = image.height;
  return header;
}

// Handles a line; false: it is none of the messages, or the answer can't be written.
bool handle(VariationPlayer& player, const Result<void>& opened, const std::string& line) {
  if (const std::optional<ImageRequest> request = decode_image_request(line)) {
    render::Pixels image;
    ImageHeader header;
    if (opened) {
      header = player.draw(*request, image);
    } else {
      header.error = opened.error();
    }
    return system::write_all(system::kStandardOutput, encode(header) + "\n") &&
           system::write_all(system::kStandardOutput, {reinterpret_cast<const char*>(image.bytes.data()),
                                                       header.width > 0 ? image.bytes.size() : 0});
  }
  std::optional<experiments::Request> request = experiments::decode_request(line);
  if (!request) return false;
  if (auto* const setup = std::get_if<WorkerSetup>(&*request)) {
    player.set_up(std::move(*setup));
  } else {
    player.play(std::get<Evaluation>(*request));
  }
  return true;
}

// Ends this process when `limber breed` has ended, even if the scene computes for long or the display doesn't answer.
void end_with_input() {
  std::thread watch;
  const bool started = system::start_thread(watch, [] {
    std::array<system::PollEntry, 1> input = {{{system::kStandardInput, false, false}}};
    while (!system::wait_ready(input, std::nullopt)) {
    }
    end_program(kSuccess);
  });
  if (started) watch.detach();
}

}  // namespace

int run_variation_worker(const DisplayOptions& display) {
  system::block_signals();
  start_output(OutputMode::batch);
  end_with_input();
  VariationPlayer player;
  const Result<void> opened = player.open(display);
  InputLines lines;
  while (const std::optional<std::string> line = lines.next()) {
    if (!handle(player, opened, *line)) return fail(kUsageError, "not a message for a variation");
  }
  return kSuccess;
}

}  // namespace limber::app
