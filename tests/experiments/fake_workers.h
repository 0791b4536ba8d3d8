// FakeWorkers: workers without processes, in simulated time.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "experiments/dispatcher.h"

namespace limber::experiments::test {

/// `fate` decides what happens to an evaluation.
class FakeWorkers final : public Workers {
 public:
  enum class Fate : std::uint8_t { answer, crash, hang };

  explicit FakeWorkers(std::size_t count) : pending_(count), alive_(count, false) {}

  std::size_t count() const override { return pending_.size(); }
  Result<void> start(std::size_t worker) override {
    starts++;
    alive_[worker] = true;
    pending_[worker].clear();
    return {};
  }
  void send(std::size_t worker, std::string_view line) override {
    const std::optional<Request> request = decode_request(line);
    ASSERT_TRUE(request.has_value()) << line;
    if (std::holds_alternative<WorkerSetup>(*request)) {
      if (crash_at_setup) return add(worker, {}, 1);
      return add(worker, fault.empty() ? encode(Answer(scene)) : encode(Answer(WorkerFault{fault})), 1);
    }
    const auto& evaluation = std::get<Evaluation>(*request);
    const int tried = (*tries)[evaluation.number]++;
    const double duration = random_.uniform(0.01, 1);
    switch (fate(evaluation.number, tried)) {
      case Fate::answer:
        return add(worker, encode(Answer(Outcome{evaluation.number, {value(evaluation)}, evaluation.number + 1, ""})),
                   duration);
      case Fate::crash:
        return add(worker, {}, duration);
      case Fate::hang:
        return;
    }
  }
  std::vector<Event> wait(std::chrono::microseconds limit) override {
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < pending_.size(); i++) {
      if (!pending_[i].empty() && (!first || pending_[i].front().at < pending_[*first].front().at)) first = i;
    }
    const double end = now + std::chrono::duration<double>(limit).count();
    if (!first || pending_[*first].front().at > end) {
      now = end;
      return {};
    }
    const Pending next = pending_[*first].front();
    pending_[*first].erase(pending_[*first].begin());
    now = std::max(now, next.at);
    if (!next.line) alive_[*first] = false;
    return {{*first, next.line}};
  }
  static double value(const Evaluation& evaluation) { return 10 * evaluation.values.at(0) + 1; }

  std::function<Fate(std::uint64_t number, int tried)> fate = [](auto, auto) { return Fate::answer; };
  SceneInfo scene{{{"rate", 0, 1, 0.5, {}, false}}, {{"distance", 0, 0, 0}}};
  std::string fault;
  bool crash_at_setup = false;
  double now = 0;
  int starts = 0;
  /// Tries of each evaluation, also of other workers with the same map.
  std::shared_ptr<std::map<std::uint64_t, int>> tries = std::make_shared<std::map<std::uint64_t, int>>();

 private:
  struct Pending {
    double at;
    std::optional<std::string> line;
  };
  void add(std::size_t worker, std::optional<std::string> line, double duration) {
    pending_[worker].push_back({now + duration, std::move(line)});
  }
  std::vector<std::vector<Pending>> pending_;
  std::vector<bool> alive_;
  Random random_{5, "durations"};
};

/// Expects the outcomes of the evaluations 0 .. count - 1 with the values number / 8.
inline void expect_all(const std::vector<Outcome>& outcomes, std::uint64_t count) {
  ASSERT_EQ(outcomes.size(), count);
  for (std::uint64_t i = 0; i < count; i++) {
    EXPECT_EQ(outcomes[i].number, i);
    EXPECT_EQ(outcomes[i].error, "");
    ASSERT_EQ(outcomes[i].results.size(), 1u);
    EXPECT_EQ(outcomes[i].results[0], 10 * (static_cast<double>(i) / 8) + 1);
  }
}

}  // namespace limber::experiments::test
