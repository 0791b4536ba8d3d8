// Commands to the simulation thread, and answers and events from it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/evaluation.h"
#include "base/message.h"
#include "base/osc_config.h"

namespace limber::engine {

/// A Lua text for the running scene, from a console or the panel: run it, or complete its last word. There is no
/// message for it, so it can't come from the network.
struct EvaluationRequest {
  enum class Action : std::uint8_t { run, complete };
  Action action = Action::run;
  std::string text;  ///< Up to kMaxEvaluatedBytes.
  /// Called with the result, between two ticks. It must neither block nor throw. [sim]
  std::function<void(Evaluation)> on_result = [](const Evaluation&) {};
};

/// The messages of one datagram, applied in the same tick, or an evaluation.
struct Command {
  std::vector<Message> messages;
  CommandOrigin origin;
  std::shared_ptr<const EvaluationRequest> evaluation = nullptr;  ///< Evaluated after the messages.
  std::uint64_t arrival = 0;  ///< CommandQueue::next_arrival(); 0: the queue sets it.
};

/// An outgoing message and its destination.
struct Outgoing {
  enum class Destination : std::uint8_t {
    reply,    ///< An answer to `origin`.
    error,    ///< An error, to `origin` and to targets that subscribe to errors.
    targets,  ///< A message of the scene (osc:send), to every target.
    event,    ///< Contacts, transport, script errors: to every target and subscriber.
    direct,   ///< To the address in `origin`, which the scene has specified.
  };
  Destination destination = Destination::targets;
  CommandOrigin origin;
  Message message;
};

/// Returns the memory that the object occupies, in bytes, for the limits of queues. [any]
std::size_t weight_of(const Message& message);
std::size_t weight_of(const Command& command);
std::size_t weight_of(const Outgoing& out);

/// Maximum length of an outgoing error text in bytes: some receivers accept strings up to 1024.
inline constexpr std::size_t kMaxErrorText = 1000;
/// Returns `/error <address> <text>`, with the text shortened to kMaxErrorText. [any]
Message error_message(std::string_view address, std::string_view text);

/// Message counters of the network and the dispatch, readouts under /osc. Any thread may increment them. [any]
struct Counters {
  std::atomic<std::uint64_t> received{0};        ///< Messages received and decoded.
  std::atomic<std::uint64_t> malformed{0};       ///< Datagrams that are not valid OSC.
  std::atomic<std::uint64_t> denied{0};          ///< Datagrams from senders that --osc-allow excludes.
  std::atomic<std::uint64_t> unknown{0};         ///< Messages with an unknown address and no handler.
  std::atomic<std::uint64_t> refused{0};         ///< Rejected messages: known address, invalid arguments or names.
  std::atomic<std::uint64_t> clamped{0};         ///< Values clamped to their range.
  std::atomic<std::uint64_t> dropped{0};         ///< Dropped because the command queue was full.
  std::atomic<std::uint64_t> dropped_kernel{0};  ///< Dropped by the kernel because the socket's buffer was full.
  std::atomic<std::uint64_t> sent{0};            ///< Datagrams sent.
  std::atomic<std::uint64_t> unsent{0};          ///< Datagrams that could not be sent or were returned by ICMP.
  std::atomic<std::uint64_t> discarded{0};       ///< Requests that a later urgent request discarded.
  std::atomic<std::uint64_t> unheard{0};         ///< Messages dropped because the handler queue was full.
  std::atomic<std::uint64_t> disabled{0};        ///< Handlers that are disabled because they failed.
};

}  // namespace limber::engine
