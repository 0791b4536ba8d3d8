// BackgroundWriter: order and completeness of the work of several files.
#include "engine/background_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "engine/taken.h"

namespace limber::engine::test {
namespace {

using Clock = BackgroundWriter::Clock;

// A task that counts its runs and works until `work` is 0.
struct CountedTask : BackgroundWriter::Task {
  std::atomic<int> runs{0};
  std::atomic<int> work{1};
  Clock::time_point run() override {
    runs++;
    return --work > 0 ? Clock::now() : BackgroundWriter::kNever;
  }
};

TEST(BackgroundWriter, FinishesRequestedWork) {
  BackgroundWriter writer;
  CountedTask task;
  writer.add(task);
  writer.finish(task);
  EXPECT_EQ(task.runs, 0) << "nothing was requested";
  task.work = 5;
  EXPECT_TRUE(writer.request(task));
  writer.finish(task);
  EXPECT_EQ(task.runs, 5);
  EXPECT_TRUE(writer.request(task, Clock::now() + std::chrono::hours(1)));
  writer.finish(task);
  EXPECT_EQ(task.runs, 5) << "it is not due";
  writer.remove(task);
  EXPECT_TRUE(writer.request(task));
  writer.finish(task);
  EXPECT_EQ(task.runs, 5) << "it was removed";
}

// A file with much to write delays another one by one run.
TEST(BackgroundWriter, RunsTheTaskThatWasDueFirst) {
  struct Endless : BackgroundWriter::Task {
    std::atomic<int> runs{0};
    std::atomic<bool> stop{false};
    Clock::time_point run() override {
      runs++;
      return stop ? BackgroundWriter::kNever : Clock::now();
    }
  } endless;
  struct Witness : BackgroundWriter::Task {
    Endless& other;
    int seen = 0;
    explicit Witness(Endless& task) : other(task) {}
    Clock::time_point run() override {
      seen = other.runs;
      return BackgroundWriter::kNever;
    }
  } witness(endless);
  BackgroundWriter writer;
  writer.add(endless);
  writer.add(witness);
  EXPECT_TRUE(writer.request(endless));
  while (endless.runs < 100) std::this_thread::yield();
  EXPECT_TRUE(writer.request(witness));
  const int runs = endless.runs;
  writer.finish(witness);
  EXPECT_LE(witness.seen, runs + 1);
  endless.stop = true;
  writer.finish(endless);
  writer.remove(endless);
  writer.remove(witness);
}

// Whatever is queued while an earlier block is written in parts is part of the file.
TEST(BackgroundWriter, TakesHaveTheirEnd) {
  const ShowFolder folder;
  BackgroundWriter writer;
  for (int i = 0; i < 50; i++) {
    const std::string path = folder.path(fmt::format("{}.take", i));
    {
      TakeWriter take(writer, {path, false}, {}, [](const std::string& why) { ADD_FAILURE() << why; });
      take.write(TakeInitialState{});
      for (int k = 0; k < i; k++) {
        take.write("tick");
        take.write(TakeFiles{});
        if (k % 5 == 0) std::this_thread::yield();
      }
      take.write("the end");
    }
    EXPECT_TRUE(file_bytes(path).ends_with("the end")) << i;
  }
}

}  // namespace
}  // namespace limber::engine::test
