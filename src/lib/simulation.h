// Simulation: an engine that a program drives, with its log, events and saved states. limber.cpp is its C interface.
// One thread at a time, except where noted.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/log/log_sink.h"
#include "engine/engine.h"
#include "lib/limber.h"
#include "lib/property_handle.h"
#include "lib/view.h"

/// A saved state, in the list of its simulation.
struct limber_state {
  limber_sim* owner = nullptr;
  limber::engine::SavedState state;
};

namespace limber::lib {

/// Largest seed and number of ticks: a double is exact up to it.
inline constexpr std::uint64_t kMaxInteger = std::uint64_t{1} << 53;

/// Passes the log lines of a simulation to the program.
class ProgramLog final : public LogSink {
 public:
  ProgramLog(limber_log_function function, void* context) : function_(function), context_(context) {}
  void add(LogLevel level, std::string_view text) override;

 private:
  limber_log_function function_;
  void* context_;
};

class Simulation {
 public:
  static constexpr std::size_t kMaxEvents = 4096;

  /// `options` must be valid (check_options()).
  explicit Simulation(const limber_options& options);

  /// Runs the scene. Call it once, before everything else.
  Result<void> start() { return engine_.start(); }
  void step(std::uint64_t ticks);
  bool restart(std::optional<std::uint64_t> seed);
  /// Executes a message. The error is that of the message.
  Result<void> send(Message message);
  /// Moves the oldest event to `event`. False: there is none.
  bool next_event(limber_event& event);
  std::size_t contacts(limber_contact* contacts, std::size_t capacity);

  engine::Engine& engine() { return engine_; }
  const sim::World& world() const { return const_cast<engine::Engine&>(engine_).world(); }
  ProgramLog& log() { return log_; }
  std::list<limber_state>& states() { return states_; }
  std::list<limber_property>& properties() { return properties_; }
  View& view() { return view_; }

  /// Marks the simulation as used by this thread. False: another call is running. [any]
  bool try_enter() { return !busy_.exchange(true, std::memory_order_acquire); }
  void leave() { busy_.store(false, std::memory_order_release); }
  /// False in a child of the process that created the simulation. [any]
  bool in_its_process() const;

 private:
  void collect_events();

  ProgramLog log_;
  engine::EngineLink link_;
  engine::Engine engine_;
  std::list<limber_state> states_;
  std::list<limber_property> properties_;
  View view_;
  std::vector<engine::Outgoing> outgoing_;  // scratch
  std::deque<Message> events_;
  Message event_message_;  // of the last event
  std::vector<limber_value> event_values_;
  std::string error_;  // of the message that is executed
  std::atomic<bool> busy_{false};
  unsigned forks_;
};

/// Returns the folder with the installed data: that of the source tree or the installation that contains the library.
/// Empty: there is none. [any]
const std::string& data_folder();

/// Error: an option is out of its range, or there is neither a file nor a text.
Result<void> check_options(const limber_options& options);

}  // namespace limber::lib

struct limber_sim {
  explicit limber_sim(const limber_options& options) : simulation(options) {}
  limber::lib::Simulation simulation;
};
