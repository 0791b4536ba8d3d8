// Handles the causes that end a show, and limits the time of each wait.
#include "app/show/show_loop.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/log/log.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/service_manager.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "sim/world/body.h"

namespace limber::app {

namespace {

using namespace std::chrono_literals;
using system::Signal;

constexpr std::chrono::milliseconds kStatusInterval = 1s;

// a thread that doesn't return can't be joined; all files are written, so the process may end
[[noreturn]] void leave(std::string_view reason) {
  write_message(MessageLevel::warning, reason);
  begin_output_shutdown();
  end_program(kInputError);
}

}  // namespace

ShowLoop::ShowLoop(const EngineThread& engine_thread, engine::Engine& engine, engine::EngineLink& link,
                   ServiceNotifier& notifier, DisplayWatchdog& display_watchdog, const PlayOptions& options,
                   const ShownModels& models)
    : engine_thread_(engine_thread),
      engine_(engine),
      link_(link),
      notifier_(notifier),
      display_watchdog_(display_watchdog),
      options_(options),
      models_(models),
      prints_status_(!options.log.quiet && !system::standard_error_is_journal()) {}

void ShowLoop::wait_for_scene() {
  while (!engine_thread_.started()) {
    notifier_.loading();
    if (system::wait_for_signal(kStatusInterval) == Signal::terminate) leave("interrupted while the scene was loading");
  }
}

bool ShowLoop::may_wait_for_fix() const {
  return options_.take.replay.empty() && !options_.fast && !options_.display.headless && Window::has_display();
}

bool ShowLoop::should_await_display() const {
  const DisplayOptions& display = options_.display;
  const bool requested = display.full_screen || !display.monitor.empty() || notifier_.present();
  return requested && !display.headless && !options_.fast && Window::has_display();
}

bool ShowLoop::open_window() {
  if (options_.fast) return false;
  std::string reason;
  if (!options_.display.headless) {
    const Result<void> opened = try_window();
    if (opened) return true;
    reason = fmt::format(" ({})", opened.error());
  }
  awaits_display_ = should_await_display();
  print_notice("playing headless{}; {}", reason,
               awaits_display_ ? "the window opens as soon as there is a display" : "Ctrl+C ends it");
  return awaits_display_;
}

Result<void> ShowLoop::try_window() {
  auto window = display_watchdog_.call(
      [&] { return WindowShow::open(options_.display, printable(options_.scene), link_, models_); });
  if (!window) return Error{window.error()};
  window_ = std::move(*window);
  return {};
}

void ShowLoop::print_status() const {
  const std::shared_ptr<const engine::Snapshot> now = link_.snapshots.read();
  if (now == nullptr) return;
  std::size_t joints = 0;
  for (const engine::BodyEntry& body : now->body_list->bodies) joints += body.joint_offsets.size();
  const std::string line =
      fmt::format("{:8.1f} s  tick {}  {}  {}, {}  OSC in {} out {}{}", now->time, now->tick,
                  now->paused ? std::string("paused") : fmt::format("{:.2f} × real time", now->speed),
                  counted(now->body_list->bodies.size(), "body", "bodies"), counted(joints, "joint"),
                  link_.counters.received.load(), link_.counters.sent.load(),
                  link_.counters.dropped.load() + link_.counters.dropped_kernel.load() > 0 ? "  (some were lost)" : "");
  notifier_.status(line);
  if (prints_status_) write_line(OutputTo::error, "limber: " + line);
}

// retries everything that failed at the start
void ShowLoop::retry() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_retry_ < kStatusInterval) return;
  last_retry_ = now;
  if (window_ == nullptr && awaits_display_ && try_window()) awaits_display_ = false;
  retry_();
}

bool ShowLoop::run() {
  while (!engine_thread_.over()) {
    retry();
    const WindowShow::End end =
        window_ != nullptr ? display_watchdog_.call([&] { return window_->frame(); }) : WindowShow::End::none;
    if (end == WindowShow::End::lost) return run_headless();
    const bool closed = end == WindowShow::End::closed;
    const Signal signal = system::wait_for_signal(window_ != nullptr ? 0ms : kStatusInterval);
    if (signal == Signal::none && window_ == nullptr) print_status();
    if (signal != Signal::terminate && !closed) continue;
    end_show();
    return true;
  }
  return false;
}

bool ShowLoop::run_headless() {
  awaits_display_ = false;
  while (!engine_thread_.over()) {
    retry();
    const Signal signal = system::wait_for_signal(kStatusInterval);
    if (signal == Signal::none) print_status();
    if (signal != Signal::terminate) continue;
    end_show();
    return true;
  }
  return false;
}

void ShowLoop::close_window() {
  display_watchdog_.call([&] { window_.reset(); });
}

void ShowLoop::end_show() {
  begin_output_shutdown();
  notifier_.stopping();
  engine_.stop();
  // wait 0.9 s for the tick to finish, after another signal 0.25 s. Not less, since that signal may be a duplicate of
  // the first one (sent to the program and to its process group)
  using Clock = std::chrono::steady_clock;
  Clock::time_point deadline = Clock::now() + 900ms;
  while (!engine_thread_.over() && Clock::now() < deadline) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (system::wait_for_signal(left) != Signal::terminate) continue;
    deadline = std::min(deadline, Clock::now() + std::chrono::milliseconds(250));
  }
  if (!engine_thread_.over()) leave("interrupted during a long tick. Reduce substeps or solver_iterations");
}

}  // namespace limber::app
