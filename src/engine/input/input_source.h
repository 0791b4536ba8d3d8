// InputSource: provides the inputs of each pass of the engine: messages, runs of the scene, and decisions that depend
// on real time. LiveInput reads them from controllers, TakeInput from a take, HistoryInput from the history of a
// rewind.
#pragma once

#include <cstdint>
#include <memory>

#include "base/message.h"
#include "engine/commands/outcome.h"
#include "engine/cues/cue_player.h"
#include "engine/takes/take.h"
#include "engine/transport.h"
#include "script/scene/sources.h"

namespace limber::engine {

/// [sim]
class InputSource {
 public:
  virtual ~InputSource() = default;

  /// Executes the messages of the pass. `may_step`: simulated time may advance in this pass.
  virtual void execute_messages(bool may_step) = 0;
  /// True if simulated time advances in this pass. Call it once, after its messages.
  virtual bool advances_time(bool may_step) = 0;

  /// Begins the calls of handlers in this pass.
  virtual void begin_handlers() {}
  /// True if another handler may be called after `called` calls in this pass.
  virtual bool may_call_handler(std::uint64_t called) const = 0;
  /// Ends the calls of handlers in this pass.
  virtual void end_handlers(std::uint64_t called) = 0;

  /// Records an executed message as an input of the pass, or Lua code from a console (`evaluate`, in the address).
  virtual void record(const Message& message, const CommandOrigin& origin, bool evaluate) = 0;
  /// Executes a request to rewind.
  virtual Outcome rewind(const Transport::RewindRequest& request, const CommandOrigin& origin) = 0;
  /// Executes a request about takes.
  virtual Outcome request_take(const Message& message) = 0;
  /// Accepts a request of a controller to start or pause cues. The default ignores it, because the messages of cues
  /// are recorded inputs themselves.
  virtual Outcome request_cue(const CueRequest&) { return {}; }
  /// True if a cue waits for this message.
  virtual bool starts_cue(const Message&) { return false; }
  /// Passes on a request to learn or forget a MIDI control. The default ignores it: a replay changes no map.
  virtual Outcome request_midi(const Message&, const CommandOrigin&) { return {}; }

  /// Passes on a request about the targets of OSC. The default ignores it: a replay sends to the targets of its own
  /// command line.
  virtual Outcome request_osc(const Message&, const CommandOrigin&) { return {}; }

  /// Input of a run of the scene.
  struct SceneFiles {
    std::shared_ptr<const script::Sources> sources;  ///< Read instead of the files on disk; null: the files on disk.
    bool fails = false;                              ///< The run failed when it was recorded.
  };
  /// Returns the files of the next run, which has this kind.
  virtual SceneFiles begin_run(TakeSceneRun::Kind) { return {}; }
  /// Returns whether the engine must run the scene again itself, now, because a parameter with `rerun` has changed.
  /// False if it must not be run again, or if another thread does so.
  virtual bool must_rerun() { return false; }

  /// Compares the state after the pass with the recorded one, if there is one.
  virtual void end_pass() {}
  /// True if the next tick waits for its time.
  virtual bool is_paced() const { return false; }
  /// True if there are no further inputs.
  virtual bool finished() const { return false; }
  /// Error: changes of the scene by other threads are rejected, because the take contains all input.
  virtual Result<void> accepts_changes() const { return {}; }
};

}  // namespace limber::engine
