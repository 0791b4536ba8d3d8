// ShowLoop: the main thread while a show plays: signals, the window or the status line, the service manager.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include "app/frame_watch.h"
#include "app/play.h"
#include "app/service_notifier.h"
#include "app/show.h"
#include "app/window_show.h"
#include "engine/engine.h"
#include "engine/link.h"

namespace limber {

/// [main]
class ShowLoop {
 public:
  /// All of them outlive it.
  ShowLoop(const Show& show, Engine& engine, EngineLink& link, ServiceNotifier& notifier, FrameWatch& frames,
           const PlayOptions& options);

  /// Until the scene has run. A signal ends the program.
  void wait_for_scene();
  /// Whether an empty stage may wait until its scene is mended: in a window, but nobody mends a take.
  bool may_wait_for_mending() const;
  /// Opens the window. False: there is none, which was reported, and none is waited for.
  bool open_window();
  /// Called about once a second while the show plays: what could not be had at the start is tried again.
  void each_second(std::function<void()> retry) { retry_ = std::move(retry); }
  /// Until the show is over by itself, or a signal or the window ends it; true: one of them did.
  bool run();
  /// The same, without the window, whose display is gone.
  bool run_headless();
  /// Closes the window, if there is one.
  void close_window();

 private:
  /// The window was requested, so that it opens as soon as there is a display.
  bool waits_for_display() const;
  bool try_window();
  void print_status() const;
  void retry();
  void end_show();

  const Show& show_;
  Engine& engine_;
  EngineLink& link_;
  ServiceNotifier& notifier_;
  FrameWatch& frames_;
  const PlayOptions& options_;
  const bool prints_status_;
  std::unique_ptr<WindowShow> window_;
  bool waits_ = false;  // for a display
  std::function<void()> retry_ = [] {};
  std::chrono::steady_clock::time_point retried_;
};

}  // namespace limber
