// EngineLink: the thread-safe interface of a running engine: the queue of commands to it, snapshots, answers and the
// OSC port configuration from it, and counters. Every member may be used from any thread.
#pragma once

#include <atomic>
#include <functional>
#include <utility>

#include "base/result.h"
#include "base/threads/bounded_queue.h"
#include "base/threads/latest.h"
#include "engine/commands/command.h"
#include "engine/commands/command_queue.h"
#include "engine/edits/change_log.h"
#include "engine/output/health.h"
#include "engine/output/lighting_status.h"
#include "engine/output/message_log.h"
#include "engine/output/midi_status.h"
#include "engine/output/osc_status.h"
#include "engine/output/snapshot.h"
#include "engine/output/value_snapshot.h"

namespace limber::engine {

struct EngineLink {
  static constexpr std::size_t kMaxItems = 65536;                  ///< Maximum number of waiting outgoing messages.
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;  ///< A datagram of 16 KiB may grow to 0.8 MiB.
  /// Maximum number of waiting datagrams: about twenty ticks of work if they are expensive (LiveInput::kPassWork).
  static constexpr std::size_t kMaxCommands = 16384;
  static constexpr std::size_t kMaxPanelItems = 1024;  ///< Maximum number of waiting answers to the panel.
  CommandQueue command_queue{kMaxCommands, kMaxBytes};
  /// Set by a signal handler to request a panic, like an urgent message.
  std::atomic<bool> panic_signal{false};
  /// Number of panics and of ends of takes so far. A scene change or take that was requested before one of them must
  /// not begin after it.
  std::atomic<std::uint64_t> panics{0};
  std::atomic<std::uint64_t> take_stops{0};
  std::uint64_t take_stop_count() const { return panics.load() + take_stops.load(); }
  BoundedQueue<Outgoing> output_queue{kMaxItems, kMaxBytes};
  BoundedQueue<Outgoing> query_output_queue{kMaxItems, kMaxBytes};       ///< Answers to CommandSource::oscquery.
  BoundedQueue<Outgoing> panel_output_queue{kMaxPanelItems, kMaxBytes};  ///< Answers to CommandSource::panel.
  Latest<Snapshot> snapshots;
  Latest<ValueSnapshot> value_snapshots;  ///< Made on request only.
  std::atomic<std::uint64_t> value_snapshot_requests{0};
  /// OSC ports and targets of the scene. Null: no scene has run; empty lists: not specified.
  Latest<OscConfig> osc_config;
  Counters counters;
  Health health;            ///< Things dropped, reduced, disabled or lost.
  MessageLog message_log;   ///< Messages received and sent by OSC and OSCQuery, for monitors.
  LightingStatus lighting;  ///< Of the output to lights.
  MidiStatus midi;          ///< Of MIDI devices.
  OscStatus osc;            ///< Of the targets of OSC.
  ChangeLog changes;        ///< Recent changes of values and their sources, for monitors.

  /// Called after a push to `output_queue`, `osc_config` or `value_snapshots`, for example to signal an eventfd. Set
  /// before start.
  std::function<void()> wake_network = [] {};
  /// Called after a push to `query_output_queue` or `value_snapshots`. Set before start.
  std::function<void()> wake_query = [] {};
  /// Called when a parameter with `rerun` has changed. The callee must have another thread call Engine::reload(true).
  /// Null: the simulation thread runs the scene itself. Set before start.
  std::function<void()> on_rerun;
  /// Called with messages about scenes and takes that need file access. The callee must have another thread answer them
  /// and call Engine::change_scene() or play_take(). Null: scenes can't be changed. Set before start.
  std::function<void(const Message&, const CommandOrigin&)> on_scene_request;
  /// Called with /midi/learn and /midi/forget. Null: MIDI is off. Set before start.
  std::function<void(const Message&, const CommandOrigin&)> on_midi_request;
  /// Called with /osc/target/… and /list/targets; returns the error in the arguments. Null: OSC is off. Set before
  /// start.
  std::function<Result<void>(const Message&, const CommandOrigin&)> on_osc_request;
  /// Called after a push to `command_queue`, so that a paused engine need not poll. Set by the engine.
  std::function<void()> wake_engine = [] {};

  /// Requests a value snapshot that contains the effect of all commands pushed before this call. Returns the request's
  /// number: it is served by the first snapshot with `request` >= this number.
  std::uint64_t request_value_snapshot() {
    const std::uint64_t number = value_snapshot_requests.fetch_add(1) + 1;
    wake_engine();
    return number;
  }
  /// Pushes an outgoing message to the queue of its receiver and wakes the receiver.
  void push_out(Outgoing out) {
    const bool answer =
        out.destination == Outgoing::Destination::reply || out.destination == Outgoing::Destination::error;
    if (answer && out.origin.source == CommandSource::oscquery) {
      query_output_queue.push(out);
      wake_query();
      if (out.destination == Outgoing::Destination::reply) return;
    }
    if (answer && out.origin.source == CommandSource::panel) {
      panel_output_queue.push(out);
      if (out.destination == Outgoing::Destination::reply) return;
    }
    output_queue.push(std::move(out));
    wake_network();
  }
};

}  // namespace limber::engine
