// CallEffects: requests of a guarded call that are carried out only when it succeeds: forces, messages, presets, reset,
// panic. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/message.h"
#include "script/api/force_queue.h"

namespace limber::script {

class ScriptHost;

class CallEffects {
 public:
  /// Recipients of a message: all targets, the sender of the message being handled, or one address.
  enum class Route : std::uint8_t { all, sender, direct };
  static constexpr std::size_t kMaxMessages = 10000;  ///< Messages per call.

  /// Queues a message. Returns false if the call has sent too much. `to` is ignored for Route::all.
  bool send(Route route, const CommandOrigin& to, Message message);
  void request_preset(Message request) { presets_.push_back(std::move(request)); }
  std::span<const Message> presets() const { return presets_; }
  void request_reset() { reset_ = true; }
  void request_panic() { panic_ = true; }

  /// Forgets requests for reset and panic from outside of a call.
  void begin_call() { reset_ = panic_ = false; }
  /// True if the call can be joined with the next one, because it requested nothing but forces.
  bool can_wait() const { return messages_.empty() && presets_.empty() && !reset_ && !panic_; }
  /// Applies the forces and passes the requests to the host.
  void apply(sim::World& world, ScriptHost& host);
  /// Removes the messages and presets.
  void clear();

  ForceQueue forces;

 private:
  struct RoutedMessage {
    Route route;
    CommandOrigin to;
    Message message;
  };
  std::vector<RoutedMessage> messages_;
  std::size_t text_bytes_ = 0;  // bytes of text in them
  std::vector<Message> presets_;
  bool reset_ = false;
  bool panic_ = false;
};

}  // namespace limber::script
