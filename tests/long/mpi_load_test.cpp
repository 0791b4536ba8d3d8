// The share of rank 0 in the time of 1000 ranks, in simulated time.
#include <ctime>
#include <memory>
#include <queue>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.h"
#include "experiments/ranks.h"

namespace limber::experiments::test {
namespace {

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Simulated time, which contains the processor time of rank 0, without that of the test.
class LoadClock {
 public:
  /// Adds what rank 0 has used since the last one.
  class Pause {
   public:
    explicit Pause(LoadClock& clock) : clock_(clock) {
      const double used = processor_seconds() - clock.last_;
      clock.now += used;
      clock.used += used;
    }
    ~Pause() { clock_.last_ = processor_seconds(); }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    LoadClock& clock_;
  };
  double now = 0;
  double used = 0;

 private:
  double last_ = processor_seconds();
};

/// The worker of rank 0, which is busy with its first evaluation.
class BusyWorker final : public Workers {
 public:
  explicit BusyWorker(LoadClock& clock) : clock_(clock) {}
  std::size_t count() const override { return 1; }
  Result<void> start(std::size_t /*worker*/) override { return {}; }
  void send(std::size_t /*worker*/, std::string_view line) override {
    if (std::holds_alternative<WorkerSetup>(*decode_request(line))) setups_++;
  }
  std::vector<Event> wait(std::chrono::microseconds limit) override {
    const LoadClock::Pause pause(clock_);
    clock_.now += std::chrono::duration<double>(limit).count();
    if (setups_ == 0) return {};
    setups_--;
    return {{0, encode(Answer(SceneInfo{}))}};
  }

 private:
  LoadClock& clock_;
  int setups_ = 0;
};

/// Ranks that answer after a random time with this mean.
class LoadedRanks final : public RankMessages {
 public:
  LoadedRanks(LoadClock& clock, std::size_t size, double duration)
      : clock_(clock), duration_(duration), answered_at_(size, -1) {}
  std::size_t rank() const override { return 0; }
  std::size_t size() const override { return answered_at_.size(); }
  void send(std::size_t rank, std::string_view bytes) override {
    const LoadClock::Pause pause(clock_);
    const std::optional<RankMessage> message = RankMessage::decode(bytes);
    ASSERT_TRUE(message.has_value());
    if (message->kind != RankMessage::Kind::line) return;
    const Request request = *decode_request(message->text);
    if (const auto* evaluation = std::get_if<Evaluation>(&request)) {
      const double duration = duration_ * random_.uniform(0.5, 1.5);
      if (answered_at_[rank] >= 0) idle += clock_.now - answered_at_[rank];
      answered_at_[rank] = clock_.now + duration;
      busy += duration;
      const Outcome outcome{evaluation->number, {0.25, 1.5, -3.125}, 0x123456789abcdefu, ""};
      return answer(answered_at_[rank], rank, message->start, encode(Answer(outcome)));
    }
    answer(clock_.now, rank, message->start, encode(Answer(SceneInfo{})));
  }
  std::optional<Message> receive() override {
    const LoadClock::Pause pause(clock_);
    if (pending_.empty() || pending_.top().at > clock_.now) return {};
    const Pending next = pending_.top();
    pending_.pop();
    return Message{next.rank, next.bytes};
  }

  double busy = 0;  ///< Simulated seconds in which ranks simulated.
  double idle = 0;  ///< Simulated seconds between an answer and the next evaluation.

 private:
  struct Pending {
    double at = 0;
    std::size_t rank = 0;
    std::string bytes;
    bool operator<(const Pending& other) const { return at > other.at; }
  };
  void answer(double at, std::size_t rank, std::uint64_t start, std::string line) {
    pending_.push({at, rank, RankMessage{RankMessage::Kind::line, start, std::move(line)}.encode()});
  }

  LoadClock& clock_;
  double duration_;
  std::vector<double> answered_at_;
  std::priority_queue<Pending> pending_;
  Random random_{1, "durations"};
};

// The time in which ranks wait for rank 0, of all their time, if rank 0 has a core of its own. Without the time of MPI.
TEST(LongMpi, RanksWaitForLessThanOnePercent) {
  for (const double duration : {0.026, 0.1, 1.0}) {
    LoadClock clock;
    LoadedRanks ranks(clock, 1000, duration);
    BusyWorker local(clock);
    RankWorkers workers(ranks, local, "1.0");
    Dispatcher::Options options;
    options.clock = [&] { return clock.now; };
    std::uint64_t next = 0;
    options.canceled = [&] { return next >= 100'000; };  // the evaluation of rank 0 never ends
    Dispatcher dispatcher(workers, options);
    ASSERT_TRUE(dispatcher.describe({"scene.lua", 10, {}}).ok());
    dispatcher.set_setup({"scene.lua", 10, {"a", "b", "c"}});
    const auto end = dispatcher.run(
        [&]() -> std::optional<Evaluation> {
          return Evaluation{next++, 1, {0.125, 1.0 / 3, 2.0 / 7}};
        },
        [](const Evaluation&, const Outcome&) -> Result<void> { return {}; });
    ASSERT_TRUE(end.ok()) << end.error();
    const double share = ranks.idle / (ranks.idle + ranks.busy);
    fmt::print("evaluations of {} ms: ranks wait for {:.2f} % of their time; rank 0 uses {:.1f} us for one\n",
               1e3 * duration, 100 * share, 1e6 * clock.used / static_cast<double>(next));
    EXPECT_LT(share, 0.01);
  }
}

}  // namespace
}  // namespace limber::experiments::test
