// Fuzzes the messages of experiments: those between ranks of an MPI job, and the lines to and from workers. What they
// decode is encoded to the same message. Both ends of the transport between ranks also receive the bytes.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/evaluation.h"
#include "experiments/ranks.h"
#include "fuzz/target.h"

namespace {

using namespace limber::experiments;
using limber::must;

// One message to receive; sent ones must be messages for another rank.
class OneMessage final : public RankMessages {
 public:
  OneMessage(std::size_t rank, std::string_view bytes) : rank_(rank), next_(Message{1 - rank, std::string(bytes)}) {}
  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return 2; }
  void send(std::size_t rank, std::string_view bytes) override {
    must(rank < 2 && rank != rank_ && RankMessage::decode(bytes).has_value());
  }
  std::optional<Message> receive() override { return std::exchange(next_, {}); }

 private:
  std::size_t rank_;
  std::optional<Message> next_;
};

// A worker that answers each line with itself.
class Echo final : public Workers {
 public:
  std::size_t count() const override { return 1; }
  limber::Result<void> start(std::size_t worker) override {
    must(worker == 0);
    return {};
  }
  void send(std::size_t worker, std::string_view line) override {
    must(worker == 0);
    lines_.push_back({0, std::string(line)});
  }
  std::vector<Event> wait(std::chrono::microseconds /*limit*/) override { return std::exchange(lines_, {}); }

 private:
  std::vector<Event> lines_;
};

void check_request(std::string_view line) {
  const std::optional<Request> request = decode_request(line);
  if (!request) return;
  const std::string encoded = encode(*request);
  must(encoded.find('\n') == std::string::npos);
  const std::optional<Request> again = decode_request(encoded);
  must(again && again->index() == request->index() && encode(*again) == encoded);
}

void check_answer(std::string_view line) {
  const std::optional<Answer> answer = decode_answer(line);
  if (!answer) return;
  const std::string encoded = encode(*answer);
  must(encoded.find('\n') == std::string::npos);
  const std::optional<Answer> again = decode_answer(encoded);
  must(again && again->index() == answer->index() && encode(*again) == encoded);
}

void pass_to_ranks(std::string_view bytes) {
  Echo local;
  OneMessage to_first(0, bytes);
  RankWorkers workers(to_first, local, "1.0");
  for (const Workers::Event& event : workers.wait({})) {
    must(event.worker == 1);
    if (event.line) check_answer(*event.line);
  }
  must(workers.place(1).find('\n') == std::string::npos);
  OneMessage to_second(1, bytes);
  RankWorker worker(to_second, local, "1.0", "node");
  const auto message = RankMessage::decode(bytes);
  must(worker.step() == (!message || message->kind != RankMessage::Kind::quit));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (const auto message = RankMessage::decode(bytes)) {
    must(message->encode() == bytes);
    check_request(message->text);
    check_answer(message->text);
  }
  check_request(bytes);
  check_answer(bytes);
  pass_to_ranks(bytes);
  return 0;
}
