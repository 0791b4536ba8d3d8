// Output: receives everything that the running show sends, logs and counts. While a rewind simulates recorded ticks
// again, the show is connected to MutedOutput, so that nothing is sent or counted twice. [sim]
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/log/log.h"
#include "engine/commands/message_dispatcher.h"
#include "engine/edits/change_recorder.h"
#include "engine/output/engine_link.h"
#include "engine/output/value_snapshotter.h"

namespace limber::engine {

class Output {
 public:
  virtual ~Output() = default;

  /// Sends a message.
  virtual void push(Outgoing out) = 0;
  /// Publishes the OSC ports and targets of the scene.
  virtual void configure_osc(const OscConfig& config) = 0;
  /// False if a request for another scene or take can't be carried out.
  virtual bool accepts_scene_requests() const = 0;
  /// Passes on a request for another scene or take, which needs file access.
  virtual void request_scene(const Message& message, const CommandOrigin& origin) = 0;

  /// Increments a counter.
  virtual void count(std::atomic<std::uint64_t> Counters::*counter) = 0;
  /// Logs that a value was clamped to the range of the property, once for each property.
  virtual void report_clamped(const Message& message, const Property& property) = 0;
  /// Logs a warning, once for each text.
  virtual void warn_once(const std::string& text) = 0;
  /// Logs a warning about a message, once for each text, and sends it as an error.
  virtual void warn_sender(const Message& message, const CommandOrigin& origin, const std::string& warning) = 0;
  /// Counts a rejected message as a fault and sends the error.
  virtual void report_rejected(const Message& message, const CommandOrigin& origin, std::string_view error) = 0;
  /// Counts a message with an unknown address and sends the error.
  virtual void report_unknown(const Message& message, const CommandOrigin& origin, std::string_view error) = 0;
  /// Counts and logs a fault of the show.
  virtual void report_fault(const std::string& text) = 0;
  /// Counts, logs and sends an error of a script; empty text: the errors of the file are fixed. False if muted.
  virtual bool report_script_error(std::string_view file, int line, std::string_view text) = 0;

  /// Notes that a subscriber has set a property.
  virtual void note_write(const Store& store, const CommandOrigin& origin, const PropertyRef& ref, bool clamped) = 0;
  /// Recorder of the changes that controllers make.
  virtual ChangeRecorder& changes() = 0;
  /// Writes the changes of the pass to the change log.
  virtual void flush_changes(const Store& store) = 0;
};

class LiveOutput final : public Output {
 public:
  explicit LiveOutput(EngineLink& link) : link_(link) {}

  /// Suppresses answers to senders, because the messages that are executed come from a take.
  void mute_answers(bool on) { answers_muted_ = on; }
  /// Number of faults so far.
  std::uint64_t faults() const { return faults_; }
  void add_faults(std::uint64_t count) { faults_ += count; }
  /// Makes value snapshots of the writes noted before, and of the store.
  ValueSnapshotter& value_snapshotter() { return value_snapshotter_; }

  void push(Outgoing out) override;
  void configure_osc(const OscConfig& config) override;
  bool accepts_scene_requests() const override { return link_.on_scene_request != nullptr; }
  void request_scene(const Message& message, const CommandOrigin& origin) override {
    link_.on_scene_request(message, origin);
  }
  void count(std::atomic<std::uint64_t> Counters::*counter) override {
    (link_.counters.*counter).fetch_add(1, std::memory_order_relaxed);
  }
  void report_clamped(const Message& message, const Property& property) override;
  void warn_once(const std::string& text) override;
  void warn_sender(const Message& message, const CommandOrigin& origin, const std::string& warning) override;
  void report_rejected(const Message& message, const CommandOrigin& origin, std::string_view error) override;
  void report_unknown(const Message& message, const CommandOrigin& origin, std::string_view error) override;
  void report_fault(const std::string& text) override;
  bool report_script_error(std::string_view file, int line, std::string_view text) override;
  void note_write(const Store& store, const CommandOrigin& origin, const PropertyRef& ref, bool clamped) override {
    value_snapshotter_.note_write(store, origin, ref, clamped);
  }
  ChangeRecorder& changes() override { return changes_; }
  void flush_changes(const Store& store) override { changes_.flush(store); }

 private:
  void send_error(const Message& message, const CommandOrigin& origin, std::string_view error);

  EngineLink& link_;
  ValueSnapshotter value_snapshotter_{link_.value_snapshots};
  ChangeRecorder changes_{link_.changes};
  bool answers_muted_ = false;
  std::uint64_t faults_ = 0;
  std::vector<const Property*> reported_clamped_;  // properties with a reported clamping
  std::vector<std::string> reported_warnings_;     // recently reported warnings
};

class MutedOutput final : public Output {
 public:
  void push(Outgoing) override {}
  void configure_osc(const OscConfig&) override {}
  bool accepts_scene_requests() const override { return false; }
  void request_scene(const Message&, const CommandOrigin&) override {}
  void count(std::atomic<std::uint64_t> Counters::*) override {}
  void report_clamped(const Message&, const Property&) override {}
  void warn_once(const std::string&) override {}
  void warn_sender(const Message&, const CommandOrigin&, const std::string&) override {}
  void report_rejected(const Message&, const CommandOrigin&, std::string_view) override {}
  void report_unknown(const Message&, const CommandOrigin&, std::string_view) override {}
  void report_fault(const std::string&) override {}
  bool report_script_error(std::string_view, int, std::string_view) override { return false; }
  void note_write(const Store&, const CommandOrigin&, const PropertyRef&, bool) override {}
  ChangeRecorder& changes() override { return changes_; }
  void flush_changes(const Store&) override {}

 private:
  ChangeLog log_;
  ChangeRecorder changes_{log_};
};

/// The outputs of a show. One of them is connected.
class Outputs {
 public:
  explicit Outputs(EngineLink& link) : live_(link) {}

  Output& current() { return *current_; }
  LiveOutput& live() { return live_; }
  const LiveOutput& live() const { return live_; }
  /// The state of pause that was sent last in /transport/state.
  bool sent_paused() const { return sent_paused_; }
  void set_sent_paused(bool paused) { sent_paused_ = paused; }

  /// While an object of this class exists, the muted output is connected, and this thread neither logs nor prints.
  class Muted {
   public:
    explicit Muted(Outputs& outputs) : outputs_(outputs) { outputs_.current_ = &outputs_.muted_; }
    ~Muted() { outputs_.current_ = &outputs_.live_; }
    Muted(const Muted&) = delete;
    Muted& operator=(const Muted&) = delete;

   private:
    Outputs& outputs_;
    LogSilence log_silence_;
  };

 private:
  LiveOutput live_;
  MutedOutput muted_;
  Output* current_ = &live_;
  bool sent_paused_ = false;
};

}  // namespace limber::engine
