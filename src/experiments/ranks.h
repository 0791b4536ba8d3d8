// Ranks of an MPI job: rank 0 distributes evaluations, and each rank, also rank 0, has one worker, a child process that
// it starts, restarts and ends. RankWorkers is the transport on rank 0, RankWorker the loop of the other ranks.
// [one thread]
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/dispatcher.h"

namespace limber::experiments {

/// Messages between ranks. Those from one rank to another arrive in order.
class RankMessages {
 public:
  RankMessages() = default;
  RankMessages(const RankMessages&) = delete;
  RankMessages& operator=(const RankMessages&) = delete;
  virtual ~RankMessages() = default;

  struct Message {
    std::size_t from = 0;
    std::string bytes;
  };
  virtual std::size_t rank() const = 0;
  virtual std::size_t size() const = 0;
  /// Copies the bytes and sends them in the background.
  virtual void send(std::size_t rank, std::string_view bytes) = 0;
  /// Returns the next message that has arrived; doesn't wait.
  virtual std::optional<Message> receive() = 0;
};

struct RankMessage {
  enum class Kind : std::uint8_t {
    hello,  ///< To rank 0, first: the program in the first line, the host in the second.
    start,  ///< From rank 0: start the worker; end the running one first.
    line,   ///< To the worker, or from it.
    ended,  ///< To rank 0: the worker has ended.
    quit,   ///< From rank 0: end the rank.
  };
  Kind kind = Kind::hello;
  std::uint64_t start = 0;  ///< Number of the worker's start that the message belongs to.
  std::string text;

  std::string encode() const;
  /// Returns nullopt if the bytes are not a message.
  static std::optional<RankMessage> decode(std::string_view bytes);
};

class RankWorkers final : public Workers {
 public:
  /// `local`: a transport with one worker, that of rank 0. `program`: version of the program, which must be the same on
  /// all ranks.
  RankWorkers(RankMessages& messages, Workers& local, std::string program);
  /// Ends the other ranks.
  ~RankWorkers() override;

  std::size_t count() const override { return ranks_.size(); }
  Result<void> start(std::size_t worker) override;
  void send(std::size_t worker, std::string_view line) override;
  std::vector<Event> wait(std::chrono::microseconds limit) override;
  std::string place(std::size_t worker) const override;

 private:
  struct Rank {
    std::uint64_t start = 0;
    std::string host;
  };
  void receive(std::vector<Event>& events);
  void handle(const RankMessages::Message& message, std::vector<Event>& events);

  RankMessages& messages_;
  Workers& local_;
  std::string program_;
  std::vector<Rank> ranks_;
};

class RankWorker {
 public:
  RankWorker(RankMessages& messages, Workers& local, const std::string& program, const std::string& host);

  /// Handles the messages that have arrived, then waits briefly for an answer of the worker. Returns false once rank 0
  /// has told this rank to end.
  bool step();

 private:
  bool handle(const RankMessage& message);
  void send(RankMessage::Kind kind, std::string text);

  RankMessages& messages_;
  Workers& local_;
  std::uint64_t start_ = 0;
  bool busy_ = false;  ///< Waits for the worker's answer.
  int idle_steps_ = 0;
};

}  // namespace limber::experiments
