// EngineLink: everything that the outside may touch of a running engine. Commands in; snapshots, answers and the
// plan of ports out; counters. All of it may be used from any thread.
#pragma once

#include <atomic>
#include <functional>
#include <utility>

#include "base/inbox.h"
#include "base/latest.h"
#include "engine/change_log.h"
#include "engine/command.h"
#include "engine/command_inbox.h"
#include "engine/health.h"
#include "engine/image.h"
#include "engine/snapshot.h"
#include "engine/traffic.h"

namespace limber {

struct EngineLink {
  static constexpr std::size_t kMostItems = 65536;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;  ///< A datagram of 16 KiB may grow to 0.8 MiB.
  /// Datagrams that wait: what is slow to carry out takes some twenty ticks then (Engine::kTickWork).
  static constexpr std::size_t kMostCommands = 16384;
  static constexpr std::size_t kMostPanelItems = 1024;  ///< More answers than that nobody reads.
  CommandInbox inbox{kMostCommands, kMostBytes};
  /// Set by a signal handler: a panic is requested, like an urgent message.
  std::atomic<bool> panic_signal{false};
  /// Panics and ends of takes so far: a scene or a take that was asked for before one of them doesn't begin after it.
  std::atomic<std::uint64_t> panics{0};
  std::atomic<std::uint64_t> take_stops{0};
  Inbox<Outgoing> outbox{kMostItems, kMostBytes};
  Inbox<Outgoing> query_outbox{kMostItems, kMostBytes};       ///< Answers to Hand::query.
  Inbox<Outgoing> panel_outbox{kMostPanelItems, kMostBytes};  ///< Answers to Hand::panel.
  Latest<Snapshot> snapshots;
  Latest<Image> images;  ///< Made when asked for.
  std::atomic<std::uint64_t> image_asks{0};
  Latest<OscPlan> osc_plan;  ///< What the scene wishes; null until a scene has run, empty lists: it says nothing.
  Counters counters;
  Health health;      ///< What was dropped, reduced, disabled or lost.
  Traffic traffic;    ///< What OSC and OSCQuery took and sent, for monitors.
  ChangeLog changes;  ///< Who set what lately, for monitors.

  /// Called after something was put into `outbox`, `osc_plan` or `images` (an eventfd of the network's, say). Set
  /// before start.
  std::function<void()> wake_network = [] {};
  /// The same for `query_outbox` and `images`.
  std::function<void()> wake_query = [] {};
  /// Called when a parameter with `rerun` has changed: somebody calls Engine::reload(true), on a thread of his own.
  /// Null: the simulation runs the scene itself. Set before start.
  std::function<void()> rerun_scene;
  /// Called with a message about the show's scenes; somebody who may read files answers it, and may call
  /// Engine::change_scene(), on a thread of his own. Null: scenes can't be changed. Set before start.
  std::function<void(const Message&, const Origin&)> ask_scenes;
  /// Called after something was put into `inbox`, so that a paused engine need not poll. Set by the engine.
  std::function<void()> wake_engine = [] {};

  /// Asks for an image of a moment when every command that has been pushed before this call has been carried out: one
  /// whose `asks` is at least what this gives.
  std::uint64_t ask_image() {
    const std::uint64_t number = image_asks.fetch_add(1) + 1;
    wake_engine();
    return number;
  }
  /// Puts what goes out to where it goes.
  void push_out(Outgoing out) {
    const bool answer = out.to == Outgoing::To::sender || out.to == Outgoing::To::error;
    if (answer && out.origin.hand == Hand::query) {
      query_outbox.push(out);
      wake_query();
      if (out.to == Outgoing::To::sender) return;
    }
    if (answer && out.origin.hand == Hand::panel) {
      panel_outbox.push(out);
      if (out.to == Outgoing::To::sender) return;
    }
    outbox.push(std::move(out));
    wake_network();
  }
};

}  // namespace limber
