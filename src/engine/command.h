// What travels between the outside and the simulation: commands in, answers and events out.
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
#include "base/osc_plan.h"

namespace limber {

/// A text for the running scene, from a console or the panel. No message means it, so nothing on the network can send
/// it.
struct Evaluate {
  enum class Wish : std::uint8_t { run, complete };
  Wish wish = Wish::run;
  std::string text;  ///< Up to kMostEvaluated bytes.
  /// What came of it, at once between two ticks. It must neither wait nor throw. [sim]
  std::function<void(Evaluation)> answer = [](const Evaluation&) {};
};

/// Messages that belong together (one datagram): applied as one, in one tick. Or an evaluation.
struct Command {
  std::vector<Message> messages;
  Origin origin;
  std::shared_ptr<const Evaluate> evaluate = nullptr;  ///< Done after the messages.
  std::uint64_t arrival = 0;                           ///< CommandInbox::arrive(); 0: the inbox numbers it.
};

/// A message on its way out.
struct Outgoing {
  enum class To : std::uint8_t {
    sender,   ///< An answer, to `origin`.
    error,    ///< An answer to `origin`, and to targets that ask for errors.
    targets,  ///< A scene's osc:send: every target.
    event,    ///< Contacts, transport, script errors: every target (and later subscribers).
    direct,   ///< To `origin` as an address that the scene named.
  };
  To to = To::targets;
  Origin origin;
  Message message;
};

/// Bytes that they hold in memory, for the bounds of inboxes. [any]
std::size_t weight_of(const Message& message);
std::size_t weight_of(const Command& command);
std::size_t weight_of(const Outgoing& out);

/// Longest text of a fault that goes out, bytes: receivers take strings of 1024.
inline constexpr std::size_t kMostFaultText = 1000;
/// `/error <address> <text>`, the text short enough for every receiver. [any]
Message error_message(std::string_view address, std::string_view text);

/// What the receiver and the dispatch have counted; readouts under /osc. Any thread adds. [any]
struct Counters {
  std::atomic<std::uint64_t> received{0};        ///< Messages that came in whole.
  std::atomic<std::uint64_t> malformed{0};       ///< Datagrams that are no OSC.
  std::atomic<std::uint64_t> denied{0};          ///< Datagrams from senders whom --osc-allow leaves out.
  std::atomic<std::uint64_t> unknown{0};         ///< Messages with an address that nobody answers.
  std::atomic<std::uint64_t> refused{0};         ///< Known address, wrong arguments or names.
  std::atomic<std::uint64_t> clamped{0};         ///< Values outside their range.
  std::atomic<std::uint64_t> dropped{0};         ///< Lost here: the inbox was full.
  std::atomic<std::uint64_t> dropped_kernel{0};  ///< Lost by the kernel: the socket's buffer was full.
  std::atomic<std::uint64_t> sent{0};            ///< Datagrams sent.
  std::atomic<std::uint64_t> unsent{0};          ///< Datagrams that the system did not take, or that came back.
  std::atomic<std::uint64_t> discarded{0};       ///< Requests that a later urgent one overtook and discarded.
  std::atomic<std::uint64_t> unheard{0};         ///< Messages that the scene's handlers missed: too many waited.
  std::atomic<std::uint64_t> disabled{0};        ///< Handlers that failed and are disabled now.
};

}  // namespace limber
