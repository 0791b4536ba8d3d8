// The loop of a window.
#include "app/window_show.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/panel_setup.h"
#include "app/paths.h"
#include "base/log.h"
#include "base/output.h"
#include "base/system/clock.h"
#include "base/system/thread.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr double kLongestInterval = 0.1;  // s: what comes later is not drawn in between
constexpr double kHandStays = 0.3;        // s after its last move, a hand's view counts, not the snapshot's
constexpr double kShadersEvery = 0.25;    // s
constexpr double kTurn = 2.5;             // rad for the window's height
constexpr double kWheel = 0.88;           // of the distance, a step

Orbit orbit_of(const CameraView& camera) {
  const Lens lens = lens_of(camera, 1, 1);
  return {lens.eye, lens.target};
}

// the same poses, forms and values
bool looks_alike(const Snapshot& a, const Snapshot& b) {
  if (a.tick != b.tick || a.drawing != b.drawing || a.visuals_version != b.visuals_version ||
      a.live.size() != b.live.size() || a.overlay.size() != b.overlay.size())
    return false;
  const LiveOffsets& at = live_offsets();
  for (const RosterBody& body : b.roster->bodies) {
    if (a.live[body.enabled_at] != b.live[body.enabled_at]) return false;
    for (const std::uint32_t part : body.parts) {
      const auto same = [&](std::uint32_t offset, std::size_t width) {
        const auto* const first = a.live.data() + part + offset;
        return std::equal(first, first + width, b.live.data() + part + offset);
      };
      if (!same(at.part_position, 3) || !same(at.part_rotation, 4)) return false;
    }
  }
  return true;
}

std::vector<Arg> numbers(const Vec3& v) { return {Arg::of(v.x), Arg::of(v.y), Arg::of(v.z)}; }

}  // namespace

Result<std::unique_ptr<WindowShow>> WindowShow::open(const PictureOptions& options, const std::string& scene,
                                                     EngineLink& link) {
  // software drawing takes every core that it finds: it begins its threads from here
  system::lower_thread_priority();
  Result<PictureSize> size = picture_size(options);
  if (!size) return Error{size.error()};
  const PanelSettings settings = load_settings(settings_file());
  if (options.size.empty() && settings.window_width > 0 && settings.window_height > 0)
    *size = {settings.window_width, settings.window_height};
  Result<std::unique_ptr<Window>> window =
      Window::open(fmt::format("Limber: {}", scene), size->width, size->height, gl_apis(options.gl));
  if (!window) return Error{window.error()};
  const GlApiInfo& api = gl_api_info((*window)->api());
  // cards that have no OpenGL 3.3 are those of single-board computers
  const bool software = gl_is_software();
  const bool slow = software || api.api != GlApi::core;
  const Quality quality = picture_quality(options, slow ? Quality::low : Quality::high);
  Result<std::unique_ptr<Renderer>> renderer = Renderer::make(api.api, shader_dir(), quality);
  if (!renderer) return Error{renderer.error()};
  print_notice("window {} × {}, drawn by {} with {}", size->width, size->height, gl_driver(), api.name);
  if (slow && options.quality.empty())
    print_notice("that is {}, so the picture is of quality low; --quality high looks better",
                 software ? "software" : api.name);
  return std::unique_ptr<WindowShow>(
      new WindowShow(std::move(*window), std::move(*renderer), options, settings, scene, link));
}

WindowShow::WindowShow(std::unique_ptr<Window> window, std::unique_ptr<Renderer> renderer,
                       const PictureOptions& options, const PanelSettings& settings, std::string scene,
                       EngineLink& link)
    : window_(std::move(window)),
      renderer_(std::move(renderer)),
      settings_file_(settings_file()),
      kept_(settings),
      panel_scale_(options.panel_scale.value_or(1)),
      own_size_(!options.size.empty()),
      scene_(std::move(scene)),
      link_(link) {
  GuiOptions panel = panel_options(window_.get(), window_->api());
  panel.settings = settings;
  if (!options.monitor.empty()) panel.settings.monitor = options.monitor;
  if (options.hide_pointer) panel.settings.hide_pointer = *options.hide_pointer;
  const bool fullscreen = options.fullscreen.value_or(settings.fullscreen);
  gui_ = std::make_unique<Gui>(link_, std::move(panel));
  if (const std::string& monitor = gui_->settings().monitor; !monitor.empty()) {
    if (const Result<void> moved = window_->move_to_monitor(monitor); !moved) log_warning("{}", moved.error());
  }
  if (gui_->settings().hide_pointer) window_->hide_pointer();
  if (fullscreen) window_->toggle_full_screen();
}

WindowShow::~WindowShow() {
  PanelSettings now = gui_->settings();
  if (!own_size_ && window_->width() > 0 && !window_->is_full_screen()) {
    now.window_width = window_->width();
    now.window_height = window_->height();
  }
  now.fullscreen = window_->is_full_screen();
  if (now != kept_) save_settings(settings_file_, now);
}

void WindowShow::send(std::vector<Message> messages) {
  link_.inbox.push({std::move(messages), Origin{Hand::panel, 0, 0, false}});
  link_.wake_engine();
}

// a picture is drawn one tick late, so that there are two snapshots around it; where ticks come faster than pictures,
// the newest is drawn
void WindowShow::look_at_snapshots(double now) {
  const std::shared_ptr<const Snapshot> newest = link_.snapshots.read();
  if (newest == nullptr || newest == now_) return;
  if (now_ == nullptr) home_ = orbit_of(camera_of(*newest));
  const bool moves = now_ != nullptr && newest->tick == now_->tick + 1 && newest->drawing == now_->drawing;
  before_ = moves ? now_ : newest;
  if (moves || now_ == nullptr) {
    interval_ = std::min(now - came_, kLongestInterval);
    came_ = now;
  }
  now_ = newest;
}

// each of the two points keeps the other where it is
void WindowShow::look_from(const Orbit& orbit) {
  send({{"/visuals/camera/eye", numbers(orbit.eye)},
        {"/visuals/camera/target", numbers(orbit.target)},
        {"/visuals/camera/eye", numbers(orbit.eye)}});
}

// the panel first: what is not its own is the picture's
void WindowShow::hear_hands(int width, int height, double now) {
  const std::vector<InputEvent> events = window_->take_events();
  for (const InputEvent& event : events) gui_->push(event);
  if (output_ != nullptr) {
    for (const InputEvent& key : output_->take_keys()) gui_->push(key);
  }
  if (gui_->desk().help) gui_->key_labels(window_->key_labels());
  gui_->frame({static_cast<double>(width), static_cast<double>(height), window_->content_scale() * panel_scale_, now});
  for (const HotkeyAction action : gui_->take_actions()) act(action);
  Desk& desk = gui_->desk();
  if (desk.image != nullptr) {
    const HandView view{*now_, *desk.image, lens_of(camera_of(*now_), width, height, free_part(*gui_, width, height)),
                        width, height,      now};
    for (const InputEvent& event : events) {
      const bool release = event.kind == InputEvent::Kind::button && !event.down;
      if (release || event.kind == InputEvent::Kind::move || !gui_->wants_mouse()) hand_.event(event, view);
    }
    hand_.frame(view);
    if (std::vector<Message> messages = hand_.take_messages(); !messages.empty()) send(std::move(messages));
    if (std::string chosen = hand_.take_chosen(); !chosen.empty()) desk.choose(std::move(chosen));
    desk.mark.reset();
    if (const auto mark = hand_.mark(view)) desk.mark = {mark->x, mark->y, mark->to_x, mark->to_y, mark->name};
  }
  hear_mouse();
  follow();
}

void WindowShow::act(HotkeyAction action) {
  if (action == HotkeyAction::output) toggle_output();
  if (action == HotkeyAction::full_screen)
    output_ != nullptr ? output_->toggle_full_screen() : window_->toggle_full_screen();
  if (action != HotkeyAction::home_view && action != HotkeyAction::go_to_view) return;
  hand_.follow_nothing();
  if (action == HotkeyAction::home_view) look_from(home_);
}

void WindowShow::toggle_output() {
  if (output_ != nullptr) return output_.reset();
  Result<std::unique_ptr<OutputWindow>> opened = OutputWindow::open(*window_, scene_);
  if (opened) {
    output_ = std::move(*opened);
  } else {
    log_error("{}", opened.error());
  }
}

Result<void> WindowShow::draw_window(double mix, int width, int height) {
  if (Result<void> drawn = renderer_->draw(*before_, *now_, mix, width, height, free_part(*gui_, width, height));
      !drawn)
    return drawn;
  renderer_->show(width, height);
  gui_->paint();
  window_->swap();
  return {};
}

// after the first window's picture is on its way
Result<void> WindowShow::draw_output(double mix) {
  if (output_ != nullptr && output_->closed()) output_.reset();
  return output_ == nullptr ? Result<void>() : output_->draw(*renderer_, *before_, *now_, mix);
}

void WindowShow::follow() {
  if (!hand_.followed() || *hand_.followed() >= now_->live.size()) {
    hand_.follow_nothing();
    follows_.reset();
    return;
  }
  const Vec3 at = part_pose(*now_, *hand_.followed()).position;
  if (follows_ != hand_.followed()) {
    follows_ = hand_.followed();
    const Orbit orbit = orbit_of(camera_of(*now_));
    follows_from_ = orbit.eye - orbit.target;
  }
  look_from({at + follows_from_, at});
}

void WindowShow::hear_mouse() {
  const MouseMoves mouse = window_->take_mouse();
  if (!mouse.any() || gui_->wants_mouse() || hand_.holds()) return;
  const CameraView camera = camera_of(*now_);
  const double now = system::clock_seconds();
  if (now - moved_ > kHandStays) orbit_ = orbit_of(camera);
  moved_ = now;
  // of the part that the camera's picture fills
  const double height = std::max(window_->height(), 1) *
                        free_part(*gui_, std::max(window_->width(), 1), std::max(window_->height(), 1)).height;
  orbit_.turn(kTurn * mouse.turn_x / height, kTurn * mouse.turn_y / height);
  orbit_.shift(mouse.shift_x / height, -mouse.shift_y / height, camera.fovy);
  orbit_.zoom(std::pow(kWheel, mouse.wheel));
  if (mouse.shift_x != 0 || mouse.shift_y != 0) hand_.follow_nothing();
  follows_from_ = orbit_.eye - orbit_.target;
  look_from(orbit_);
}

void WindowShow::tell_rate(double now) {
  pictures_++;
  if (now - told_ < 1) return;
  window_->title(fmt::format("Limber: {}  {:.0f} pictures a second  {:.2f} × real time{}", scene_,
                             pictures_ / (now - told_), now_->speed, now_->paused ? "  paused" : ""));
  pictures_ = 0;
  told_ = now;
}

// a show that is paused and that nobody touches needs few pictures
void WindowShow::look_for_changes(double now) {
  const std::shared_ptr<const Snapshot> newest = link_.snapshots.read();
  const int width = window_->width();
  const int height = window_->height();
  const bool moved = newest != nullptr && (seen_ == nullptr || !newest->paused || !looks_alike(*seen_, *newest));
  const bool hands = window_->has_events() || (output_ != nullptr && output_->has_events()) || gui_->has_events();
  if (!moved && !hands && width == seen_width_ && height == seen_height_) return;
  seen_ = newest;
  seen_width_ = width;
  seen_height_ = height;
  pace_.touch(now);
}

WindowShow::End WindowShow::frame() {
  // a screen that waits for nothing would be drawn without end
  const double rate = window_->refresh_rate();
  double now = system::clock_seconds();
  const double rest = pace_.rest(now, rate);
  window_->poll(rest > 0.001 ? rest : 0);
  now = system::clock_seconds();
  if (window_->lost()) {
    log_error("the window is lost; playing on headless");
    return End::lost;
  }
  if (window_->closed()) return End::closed;
  look_for_changes(now);
  if (!pace_.due(now, rate)) return End::none;  // something came before its time
  pace_.draw(now);
  look_at_snapshots(now);
  if (now_ == nullptr) return End::none;
  if (now - shaders_looked_ > kShadersEvery) {
    shaders_looked_ = now;
    renderer_->renew_shaders();
  }
  const int width = window_->width();
  const int height = window_->height();
  const bool seen = width > 0 && height > 0;
  if (!seen && output_ == nullptr) {
    window_->poll(0.05);
    return End::none;
  }
  const double mix = interval_ <= 0 ? 1 : std::clamp((now - came_) / interval_, 0.0, 1.0);
  if (seen) {
    hear_hands(width, height, now);
    if (const Result<void> drawn = draw_window(mix, width, height); !drawn) {
      log_error("{}; playing on headless", drawn.error());
      return End::lost;
    }
  }
  if (const Result<void> drawn = draw_output(mix); !drawn) {
    log_error("{}; the output window goes", drawn.error());
    output_.reset();
  }
  tell_rate(now);
  return End::none;
}

}  // namespace limber
