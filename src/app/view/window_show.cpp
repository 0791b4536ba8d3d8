// The frame loop of a window.
#include "app/view/window_show.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/paths.h"
#include "app/view/frame_parts.h"
#include "app/view/panel_setup.h"
#include "base/log/log.h"
#include "base/log/output.h"
#include "base/system/clock.h"
#include "base/system/thread.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr double kShaderCheckInterval = 0.25;  // s

}  // namespace

Result<std::unique_ptr<WindowShow>> WindowShow::open(const DisplayOptions& options, const std::string& scene,
                                                     engine::EngineLink& link, const ShownModels& models) {
  // software renderers create their worker threads from this thread, and use every core
  system::lower_thread_priority();
  Result<ImageSize> size = image_size(options);
  if (!size) return Error{size.error()};
  const panel::GuiSettings settings = panel::load_settings(panel::settings_file());
  if (options.size.empty() && settings.window_width > 0 && settings.window_height > 0)
    *size = {settings.window_width, settings.window_height};
  Result<std::unique_ptr<Window>> window =
      Window::open(fmt::format("Limber: {}", scene), size->width, size->height, render::gl_apis(options.gl));
  if (!window) return Error{window.error()};
  const render::GlApiInfo& api = render::gl_api_info((*window)->api());
  // GPUs without OpenGL 3.3 are those of single-board computers
  const bool software = render::gl_is_software();
  const bool slow = software || api.api != render::GlApi::core;
  const render::Quality quality = render_quality(options, slow ? render::Quality::low : render::Quality::high);
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::make(api.api, shader_dir(), quality);
  if (!renderer) return Error{renderer.error()};
  print_notice("window {} × {}, drawn by {} with {}", size->width, size->height, render::gl_driver(), api.name);
  if (slow && options.quality.empty())
    print_notice("using --quality low because of {}; --quality high looks better",
                 software ? "software rendering" : api.name);
  return std::unique_ptr<WindowShow>(
      new WindowShow(std::move(*window), std::move(*renderer), options, settings, scene, link, models));
}

WindowShow::WindowShow(std::unique_ptr<Window> window, std::unique_ptr<render::Renderer> renderer,
                       const DisplayOptions& options, const panel::GuiSettings& settings, std::string scene,
                       engine::EngineLink& link, const ShownModels& models)
    : window_(std::move(window)),
      renderer_(std::move(renderer)),
      settings_file_(panel::settings_file()),
      saved_settings_(settings),
      panel_scale_(options.panel_scale.value_or(1)),
      fixed_size_(!options.size.empty()),
      scene_(std::move(scene)),
      link_(link),
      models_(models) {
  panel::GuiOptions panel = panel_options(window_.get(), window_->api(), &models_);
  panel.settings = settings;
  if (!options.monitor.empty()) panel.settings.monitor = options.monitor;
  if (options.hide_pointer) panel.settings.hide_pointer = *options.hide_pointer;
  const bool full_screen = options.full_screen.value_or(settings.full_screen);
  gui_ = std::make_unique<panel::Gui>(link_, std::move(panel));
  if (const std::string& monitor = gui_->settings().monitor; !monitor.empty()) {
    if (const Result<void> moved = window_->move_to_monitor(monitor); !moved) log_warning("{}", moved.error());
  }
  if (gui_->settings().hide_pointer) window_->hide_pointer();
  if (full_screen) window_->toggle_full_screen();
}

WindowShow::~WindowShow() {
  panel::GuiSettings now = gui_->settings();
  if (!fixed_size_ && window_->width() > 0 && !window_->is_full_screen()) {
    now.window_width = window_->width();
    now.window_height = window_->height();
  }
  now.full_screen = window_->is_full_screen();
  if (now != saved_settings_) panel::save_settings(settings_file_, now);
}

void WindowShow::send(std::vector<Message> messages) {
  link_.command_queue.push({std::move(messages), CommandOrigin{CommandSource::panel, 0, 0, false}});
  link_.wake_engine();
}

void WindowShow::update_snapshots(double now) {
  std::shared_ptr<const engine::Snapshot> newest = link_.snapshots.read();
  if (newest == nullptr) return;
  if (snapshots_.empty()) camera_.set_default_view(*newest);
  snapshots_.add(std::move(newest), now);
}

// the panel has priority; the view receives the remaining events
void WindowShow::handle_input(int width, int height, double now) {
  const std::vector<panel::InputEvent> events = window_->consume_events();
  for (const panel::InputEvent& event : events) gui_->push(event);
  if (output_ != nullptr) {
    for (const panel::InputEvent& key : output_->consume_keys()) gui_->push(key);
  }
  if (gui_->context().show_help) gui_->set_key_labels(window_->key_labels());
  gui_->frame({static_cast<double>(width), static_cast<double>(height), window_->content_scale() * panel_scale_, now});
  for (const panel::HotkeyAction action : gui_->consume_actions()) act(action);
  panel::GuiContext& context = gui_->context();
  if (context.value_snapshot != nullptr) {
    const ViewState view{snapshots_.current(),
                         *context.value_snapshot,
                         render::camera_matrices(engine::camera_of(snapshots_.current()), width, height,
                                                 free_part(*gui_, width, height)),
                         width,
                         height,
                         now};
    for (const panel::InputEvent& event : events) {
      const bool release = event.kind == panel::InputEvent::Kind::button && !event.down;
      if (release || event.kind == panel::InputEvent::Kind::move || !gui_->wants_mouse())
        viewport_mouse_.event(event, view);
    }
    viewport_mouse_.frame(view);
    if (std::vector<Message> messages = viewport_mouse_.consume_messages(); !messages.empty())
      send(std::move(messages));
    if (std::string selection = viewport_mouse_.consume_selection(); !selection.empty())
      context.select(std::move(selection));
    context.spring_marker = viewport_mouse_.spring_marker(view);
  }
  handle_mouse();
  follow_part();
  for (const std::string& path : window_->consume_dropped()) models_.drop(path);
}

void WindowShow::act(panel::HotkeyAction action) {
  if (action == panel::HotkeyAction::toggle_output_window) toggle_output();
  if (action == panel::HotkeyAction::toggle_full_screen)
    output_ != nullptr ? output_->toggle_full_screen() : window_->toggle_full_screen();
  if (action == panel::HotkeyAction::frame_selection || action == panel::HotkeyAction::frame_all) return frame(action);
  if (action != panel::HotkeyAction::default_view && action != panel::HotkeyAction::restore_view) return;
  viewport_mouse_.stop_following();
  if (action == panel::HotkeyAction::default_view) send(camera_.default_view());
}

// Frames the selected object, or everything.
void WindowShow::frame(panel::HotkeyAction action) {
  panel::GuiContext& context = gui_->context();
  if (context.value_snapshot == nullptr) return;
  const bool all = action == panel::HotkeyAction::frame_all;
  const engine::Snapshot& snapshot = snapshots_.current();
  const std::vector<sim::FramedSphere> spheres =
      all ? spheres_of_all(snapshot) : spheres_of(snapshot, parts_of(*context.value_snapshot->tree, context.selected));
  if (spheres.empty())
    return context.show_notice(all ? "There are no bodies to frame" : "Select a body or a part first");
  viewport_mouse_.stop_following();
  const engine::CameraSettings camera = engine::camera_of(snapshot);
  const int width = std::max(window_->width(), 1);
  const int height = std::max(window_->height(), 1);
  const render::FreeArea free_area = free_part(*gui_, width, height);
  const double aspect = camera.aspect > 0 ? camera.aspect : static_cast<double>(width) / height;
  send(CameraControl::frame(camera, spheres, aspect * free_area.width / free_area.height));
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
  if (Result<void> drawn = renderer_->draw(snapshots_.previous(), snapshots_.current(), mix, width, height,
                                           free_part(*gui_, width, height));
      !drawn)
    return drawn;
  renderer_->present(width, height);
  gui_->render();
  window_->swap();
  return {};
}

// after the first window's frame was submitted
Result<void> WindowShow::draw_output(double mix) {
  if (output_ != nullptr && output_->closed()) output_.reset();
  return output_ == nullptr ? Result<void>()
                            : output_->draw(*renderer_, snapshots_.previous(), snapshots_.current(), mix);
}

void WindowShow::follow_part() {
  const std::optional<std::uint32_t> part = viewport_mouse_.followed();
  if (!part || *part >= snapshots_.current().transient.size()) {
    viewport_mouse_.stop_following();
    return camera_.stop_following();
  }
  send(camera_.follow(snapshots_.current(), *part));
}

void WindowShow::handle_mouse() {
  const MouseMovement mouse = window_->consume_mouse();
  if (!mouse.any() || gui_->wants_mouse() || viewport_mouse_.has_grab()) return;
  // relative to the part of the window that the panel leaves free
  const double height = std::max(window_->height(), 1) *
                        free_part(*gui_, std::max(window_->width(), 1), std::max(window_->height(), 1)).height;
  if (mouse.pan_x != 0 || mouse.pan_y != 0) viewport_mouse_.stop_following();
  send(camera_.move(mouse, engine::camera_of(snapshots_.current()), height, system::clock_seconds()));
}

void WindowShow::update_title(double now) {
  const std::optional<double> rate = frames_.count(now);
  if (!rate) return;
  const engine::Snapshot& snapshot = snapshots_.current();
  window_->set_title(fmt::format("Limber: {}  {:.0f} frames per second  {:.2f} × real time{}", scene_, *rate,
                                 snapshot.speed, snapshot.paused ? "  paused" : ""));
}

void WindowShow::check_for_changes(double now) {
  const bool input = window_->has_events() || (output_ != nullptr && output_->has_events()) || gui_->has_events();
  if (changes_.changed(link_.snapshots.read(), window_->width(), window_->height(), input)) pace_.note_activity(now);
}

WindowShow::End WindowShow::frame() {
  // limits the rate if the screen doesn't
  const double rate = window_->refresh_rate();
  double now = system::clock_seconds();
  const double wait = pace_.wait_time(now, rate);
  window_->poll(wait > 0.001 ? wait : 0);
  now = system::clock_seconds();
  if (window_->lost()) {
    log_error("the window is lost; playing on headless");
    return End::lost;
  }
  if (window_->closed()) return End::closed;
  check_for_changes(now);
  if (!pace_.frame_due(now, rate)) return End::none;  // woken by an event before the next frame
  pace_.begin_frame(now);
  update_snapshots(now);
  if (snapshots_.empty()) return End::none;
  if (now - shader_check_time_ > kShaderCheckInterval) {
    shader_check_time_ = now;
    renderer_->reload_shaders();
  }
  const int width = window_->width();
  const int height = window_->height();
  const bool visible = width > 0 && height > 0;
  if (!visible && output_ == nullptr) {
    window_->poll(0.05);
    return End::none;
  }
  const double mix = snapshots_.mix(now);
  if (visible) {
    handle_input(width, height, now);
    if (const Result<void> drawn = draw_window(mix, width, height); !drawn) {
      log_error("{}; playing on headless", drawn.error());
      return End::lost;
    }
  }
  if (const Result<void> drawn = draw_output(mix); !drawn) {
    log_error("{}; closing the output window", drawn.error());
    output_.reset();
  }
  update_title(now);
  return End::none;
}

}  // namespace limber::app
