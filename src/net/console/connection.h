// ConsoleConnection: the server's end of a connection to a console. Limits pending requests to one, the length of a
// line, and unread output.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/system/descriptor.h"
#include "base/system/wait.h"
#include "net/console/protocol.h"
#include "net/console/subscription.h"

namespace limber::console {

/// [console]
class ConsoleConnection {
 public:
  /// Queues a request; its result arrives later through finish_request(). Returns an error text, or an empty one.
  using Submit = std::function<std::string(const ConsoleRequest&)>;
  /// Creates the subscription for a request.
  using Subscribe = std::function<Result<std::unique_ptr<Subscription>>(const ConsoleRequest&)>;

  /// Log lines after number `seen` will be sent.
  ConsoleConnection(system::Descriptor connection, std::uint64_t seen);

  int fd() const { return connection_.fd(); }
  /// Returns the descriptor and the events to poll for.
  system::PollEntry poll_entry() const;
  /// Appends a line to the output buffer.
  void append(std::string_view line);
  /// Reads available input and handles the next request unless one is pending.
  void receive(const Submit& submit, const Subscribe& subscribe);
  /// Sends the log lines and the result of the pending request.
  void finish_request(std::uint64_t id, const Evaluation& result);
  /// Sends new log lines. Deferred while a request is pending, so that its own output can be labeled with its id.
  void send_log();
  /// Sends new lines of the subscription.
  void send_subscribed();
  /// Writes as much output as the socket accepts.
  void send();
  /// True if the connection can be removed. A closed connection with a pending request stays until its result arrives,
  /// so the number of pending requests is bounded by the number of connections.
  bool finished() const { return !pending_ && (broken_ || (input_ended_ && output_.empty())); }

 private:
  void read_some();
  bool next_line(std::string& line);
  void handle(const std::string& line, const Submit& submit, const Subscribe& subscribe);
  void append_or_drop(std::string_view line);
  void drop_connection();
  void send_log_lines(std::uint64_t up_to, std::uint64_t id);
  bool output_full() const;

  system::Descriptor connection_;
  std::string input_;
  std::string output_;
  std::uint64_t seen_;
  std::uint64_t dropped_ = 0;
  std::unique_ptr<Subscription> subscription_;
  bool pending_ = false;      // a request is pending
  bool input_ended_ = false;  // the other end has closed its side
  bool broken_ = false;
};

}  // namespace limber::console
