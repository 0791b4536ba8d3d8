// LiveInput: executes the commands of controllers: urgent requests first, then the queued commands within a work budget
// per pass. While a take is replayed, it rejects them. [sim]
#pragma once

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/commands/urgent.h"
#include "engine/cues/cue_runner.h"
#include "engine/history/rewinder.h"
#include "engine/takes/recording.h"

namespace limber::engine {

/// Time budget of handlers (osc:on), a token bucket: it refills by kShare of real time, up to kMaxSeconds. One call may
/// overdraw it; the next calls then wait until it is positive again. Messages are handled in order, and the values that
/// they set take effect at once.
class HandlerBudget {
 public:
  static constexpr double kShare = 0.5;
  static constexpr double kMaxSeconds = 0.008;

  /// Refills the budget; the calls of a pass begin `now` (s).
  void begin(double now);
  bool exceeded(double now) const { return now >= begun_ + seconds_; }
  void end(double now) { seconds_ -= now - begun_; }

 private:
  double seconds_ = 0;  // time left; negative: debt
  double begun_ = 0;    // s, time of the last begin()
};

/// Measures the first second of a panic, in which another request for a panic is ignored, so that pressing the button
/// twice does not end it.
class PanicTimer {
 public:
  static constexpr double kSeconds = 1;

  /// Call it once per pass, at the time `now` (s). `step`: seconds to add to the panic's age; without a value, the time
  /// since the last call. Returns true when the first second is over.
  bool update(const sim::Panic& panic, double now, std::optional<double> step);
  /// Restarts the measurement at real time `now`.
  void restart(double now);

 private:
  double age_ = 0;          // s
  double last_update_ = 0;  // s
};

/// Requests for ticks (/transport/step) that are not finished: their senders get an answer, and their queries (/get)
/// wait.
class StepRequests {
 public:
  static constexpr std::size_t kMax = 4096;
  static constexpr std::size_t kMaxQueries = 256;

  /// Notes a request for ticks that was accepted, or discarded because a pause overtook it. Beyond kMax, it gets no
  /// answer.
  void add(const CommandOrigin& origin);
  /// Postpones a query whose sender waits for ticks. Returns true if the message was postponed.
  bool postpone(const Message& message, const CommandOrigin& origin);
  /// Calls `answer` with the sender of each request, and ends the requests.
  void finish(const std::function<void(const CommandOrigin&)>& answer);
  struct Query {
    Message message;
    CommandOrigin origin;
  };
  /// Returns the postponed queries and removes them.
  std::vector<Query> consume_queries() { return std::exchange(queries_, {}); }

 private:
  std::vector<CommandOrigin> origins_;
  std::vector<Query> queries_;
};

class LiveInput final : public InputSource {
 public:
  /// Work budget of the messages of one pass: 1 per message and per value, more if a text is formatted or the scene has
  /// handlers. The remaining messages wait in order for the next passes, so a flood does not stop time. A datagram is
  /// never split.
  static constexpr int kPassWork = 8192;

  LiveInput(ShowState& show, CommandExecutor& executor, Rewinder& rewinder, TakeRecording& recording)
      : show_(show), executor_(executor), rewinder_(rewinder), recording_(recording), cues_(show, executor) {}

  void execute_messages(bool may_step) override;
  bool advances_time(bool may_step) override;
  void begin_handlers() override;
  bool may_call_handler(std::uint64_t called) const override;
  void end_handlers(std::uint64_t called) override;
  void record(const Message& message, const CommandOrigin& origin, bool evaluate) override;
  Outcome rewind(const Transport::RewindRequest& request, const CommandOrigin& origin) override;
  Outcome request_take(const Message& message) override { return recording_.request(message); }
  Outcome request_cue(const CueRequest& request) override { return cues_.request(request); }
  bool starts_cue(const Message& message) override { return cues_.starts(message); }
  Outcome request_midi(const Message& message, const CommandOrigin& origin) override;
  Outcome request_osc(const Message& message, const CommandOrigin& origin) override;
  bool must_rerun() override;
  bool is_paced() const override;
  void end_pass() override;

  /// Answers queries and rejects all other commands of this pass. /take/stop sets `stop` to true, and a panic remains
  /// queued for the next pass. If `stop` is null, both are rejected as well.
  void reject_messages(const char* reason, bool* stop);
  /// Rejects the commands that have left the queue, within the work budget of a pass.
  void reject_commands(const char* reason, bool* stop = nullptr);
  /// Number of the last request for a value snapshot that can be served now: it must contain the effect of all commands
  /// that arrived before the request.
  std::uint64_t snapshot_requests() const { return snapshot_requests_; }

 private:
  void update_panic_timer(bool may_step);
  void execute_urgent(EditScope& edit_scope);
  int execute(Command& command, EditScope& edit_scope);
  bool waits_for_ticks() const { return show_.options.lockstep && show_.session->transport.steps() > 0; }
  void correct_beat(Message& message) const;
  bool discard_if_overtaken(const Message& message, std::uint64_t arrival);
  void reject_urgent(const char* reason, bool* stop);
  void reject(const Message& message, const CommandOrigin& origin, const char* reason, bool* stop);
  void record_event(const TakeEvent& event);

  ShowState& show_;
  CommandExecutor& executor_;
  Rewinder& rewinder_;
  TakeRecording& recording_;
  CueRunner cues_;
  std::vector<Command> commands_;
  std::size_t next_command_ = 0;                  // index of the first command that is not executed
  std::uint64_t snapshot_requests_of_batch_ = 0;  // value snapshot requests made before commands_ was drained
  std::uint64_t snapshot_requests_ = 0;
  std::vector<UrgentRequest> urgent_;   // scratch
  UrgentPrecedence urgent_precedence_;  // decides which messages urgent requests discard
  StepRequests step_requests_;
  PanicTimer panic_timer_;
  HandlerBudget handler_budget_;
};

}  // namespace limber::engine
