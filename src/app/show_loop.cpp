// What ends a show, and how long it is waited for.
#include "app/show_loop.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/log.h"
#include "base/output.h"
#include "base/system/service_manager.h"
#include "base/system/signals.h"
#include "base/text.h"

namespace limber {

namespace {

using namespace std::chrono_literals;
using system::Signal;

constexpr std::chrono::milliseconds kStatusEvery = 1s;

// a thread that does not come back can't be joined: the files are whole, so the process may go
[[noreturn]] void leave(std::string_view why) {
  write_message(MessageLevel::warning, why);
  hurry_output();
  end_program(kInput);
}

}  // namespace

ShowLoop::ShowLoop(const Show& show, Engine& engine, EngineLink& link, ServiceNotifier& notifier, FrameWatch& frames,
                   const PlayOptions& options)
    : show_(show),
      engine_(engine),
      link_(link),
      notifier_(notifier),
      frames_(frames),
      options_(options),
      prints_status_(!options.log.quiet && !system::standard_error_is_journal()) {}

void ShowLoop::wait_for_scene() {
  while (!show_.started()) {
    notifier_.loading();
    if (system::wait_for_signal(kStatusEvery) == Signal::end) leave("ended while the scene was being read");
  }
}

bool ShowLoop::may_wait_for_mending() const {
  return options_.replay.empty() && !options_.fast && !options_.picture.headless && Window::has_display();
}

bool ShowLoop::waits_for_display() const {
  const PictureOptions& picture = options_.picture;
  const bool requested = picture.fullscreen || !picture.monitor.empty() || notifier_.present();
  return requested && !picture.headless && !options_.fast && Window::has_display();
}

bool ShowLoop::open_window() {
  if (options_.fast) return false;
  std::string why;
  if (!options_.picture.headless) {
    auto window = frames_.call([&] { return WindowShow::open(options_.picture, printable(options_.scene), link_); });
    if (window) {
      window_ = std::move(*window);
      return true;
    }
    why = fmt::format(" ({})", window.error());
  }
  waits_ = waits_for_display();
  print_notice("playing headless{}; {}", why,
               waits_ ? "the window opens as soon as there is a display" : "Ctrl+C ends it");
  return waits_;
}

bool ShowLoop::try_window() {
  auto window = frames_.call([&] { return WindowShow::open(options_.picture, printable(options_.scene), link_); });
  if (!window) return false;
  window_ = std::move(*window);
  return true;
}

void ShowLoop::print_status() const {
  const std::shared_ptr<const Snapshot> now = link_.snapshots.read();
  if (now == nullptr) return;
  std::size_t joints = 0;
  for (const RosterBody& body : now->roster->bodies) joints += body.joints.size();
  const std::string line =
      fmt::format("{:8.1f} s  tick {}  {}  {} bodies, {} joints  OSC in {} out {}{}", now->time, now->tick,
                  now->paused ? std::string("paused") : fmt::format("{:.2f} × real time", now->speed),
                  now->roster->bodies.size(), joints, link_.counters.received.load(), link_.counters.sent.load(),
                  link_.counters.dropped.load() + link_.counters.dropped_kernel.load() > 0 ? "  (some were lost)" : "");
  notifier_.status(line);
  if (prints_status_) write_line(OutputTo::error, "limber: " + line);
}

// what could not be had at the start
void ShowLoop::retry() {
  const auto now = std::chrono::steady_clock::now();
  if (now - retried_ < kStatusEvery) return;
  retried_ = now;
  if (window_ == nullptr && waits_ && try_window()) waits_ = false;
  retry_();
}

bool ShowLoop::run() {
  while (!show_.over()) {
    retry();
    const WindowShow::End end =
        window_ != nullptr ? frames_.call([&] { return window_->frame(); }) : WindowShow::End::none;
    if (end == WindowShow::End::lost) return run_headless();
    const bool closed = end == WindowShow::End::closed;
    const Signal heard = system::wait_for_signal(window_ != nullptr ? 0ms : kStatusEvery);
    if (heard == Signal::none && window_ == nullptr) print_status();
    if (heard != Signal::end && !closed) continue;
    end_show();
    return true;
  }
  return false;
}

bool ShowLoop::run_headless() {
  waits_ = false;
  while (!show_.over()) {
    retry();
    const Signal heard = system::wait_for_signal(kStatusEvery);
    if (heard == Signal::none) print_status();
    if (heard != Signal::end) continue;
    end_show();
    return true;
  }
  return false;
}

void ShowLoop::close_window() {
  frames_.call([&] { window_.reset(); });
}

void ShowLoop::end_show() {
  hurry_output();
  notifier_.stopping();
  engine_.stop();
  // somebody waits: a second, or for less once there was another signal; that may have come with the first, as to a
  // program and to its group, and is no reason to cut a tick of usual length
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now() + 900ms;
  while (!show_.over() && Clock::now() < last) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(last - Clock::now());
    if (system::wait_for_signal(left) != Signal::end) continue;
    last = std::min(last, Clock::now() + std::chrono::milliseconds(250));
  }
  if (!show_.over()) leave("ended in the middle of a long tick: fewer substeps or solver_iterations would help");
}

}  // namespace limber
