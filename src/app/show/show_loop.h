// ShowLoop: the main thread's loop during a show: signals, window or status line, service manager.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include "app/show/engine_thread.h"
#include "app/show/play.h"
#include "app/show/service_notifier.h"
#include "app/view/display_watchdog.h"
#include "app/view/window_show.h"
#include "engine/engine.h"
#include "engine/output/engine_link.h"

namespace limber::app {

/// [main]
class ShowLoop {
 public:
  /// All arguments must outlive the loop.
  ShowLoop(const EngineThread& engine_thread, engine::Engine& engine, engine::EngineLink& link,
           ServiceNotifier& notifier, DisplayWatchdog& display_watchdog, const PlayOptions& options,
           const ShownModels& models);

  /// Waits until the scene has run. A signal ends the program.
  void wait_for_scene();
  /// True if a show with a broken scene may wait until its file is fixed: with a window, and not for a replay.
  bool may_wait_for_fix() const;
  /// Opens the window. Returns true if it is open, or opens as soon as there is a display. Reports the error.
  bool open_window();
  /// Sets a function that is called about once a second while the show plays, to open ports and the console if that
  /// failed before.
  void set_retry(std::function<void()> retry) { retry_ = std::move(retry); }
  /// Runs until the show is over, or a signal or the window ends it. Returns true if a signal or
  /// the window ended it.
  bool run();
  /// Like run(), without the window, after its display was lost.
  bool run_headless();
  /// Closes the window, if there is one.
  void close_window();

 private:
  /// True if the window was requested explicitly and therefore opens as soon as there is a display.
  bool should_await_display() const;
  Result<void> try_window();
  void print_status() const;
  void retry();
  void end_show();

  const EngineThread& engine_thread_;
  engine::Engine& engine_;
  engine::EngineLink& link_;
  ServiceNotifier& notifier_;
  DisplayWatchdog& display_watchdog_;
  const PlayOptions& options_;
  const ShownModels& models_;
  const bool prints_status_;
  std::unique_ptr<WindowShow> window_;
  bool awaits_display_ = false;  // the window opens as soon as there is a display
  std::function<void()> retry_ = [] {};
  std::chrono::steady_clock::time_point last_retry_;
};

}  // namespace limber::app
