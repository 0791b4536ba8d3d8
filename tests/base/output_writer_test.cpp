// OutputWriter with devices that are full, not ready, closed, slow or stuck: callers never wait for them, nothing is
// lost without being counted, and lines stay whole.
#include "base/output_writer.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <condition_variable>
#include <deque>
#include <thread>

#include <fmt/format.h>

#include "base/random.h"
#include "base/text.h"

namespace limber {
namespace {

using namespace std::chrono_literals;

// a device whose state the test sets
class Device {
 public:
  enum class State { ready, not_ready, stuck };

  void set(State state) {
    const std::scoped_lock lock(mutex_);
    state_ = state;
    changed_.notify_all();
  }
  /// From this number of bytes on; 0: no error.
  void fail(int error, std::size_t from = 0) {
    const std::scoped_lock lock(mutex_);
    error_ = error;
    fails_from_ = from;
  }
  /// Takes at most this much at once.
  void set_most(std::size_t bytes) { most_ = bytes; }
  std::string got() const {
    const std::scoped_lock lock(mutex_);
    return got_;
  }
  system::Written write(std::string_view bytes) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return state_ != State::stuck; });
    if (state_ == State::not_ready) return {0, EAGAIN};
    if (error_ != 0 && got_.size() >= fails_from_) return {0, error_};
    const std::string_view taken = bytes.substr(0, most_);
    got_ += taken;
    return {taken.size(), 0};
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::ready;
  int error_ = 0;
  std::size_t fails_from_ = 0;
  std::size_t most_ = 4096;
  std::string got_;
};

struct Sink : OutputDevice {
  explicit Sink(Device& of) : device(of) {}
  system::Written write(std::string_view bytes, std::chrono::nanoseconds) override { return device.write(bytes); }
  Device& device;
};

OutputStream stream(Device& device, OutputStream::Full full = OutputStream::Full::drop) {
  OutputStream made;
  made.device = std::make_unique<Sink>(device);
  made.full = full;
  return made;
}

std::vector<OutputStream> one(OutputStream made) {
  std::vector<OutputStream> list;
  list.push_back(std::move(made));
  return list;
}

constexpr auto kForever = std::nullopt;

// "a\nb\n" as {"a", "b"}; a line that is not complete is a failure
std::vector<std::string> lines_of(const std::string& text) {
  EXPECT_TRUE(text.empty() || text.ends_with('\n'))
      << text.substr(text.size() - std::min<std::size_t>(80, text.size()));
  std::vector<std::string> lines;
  for (const std::string_view line : split(text, '\n')) lines.emplace_back(line);
  lines.pop_back();
  return lines;
}

// the numbers that the notices among these lines tell, and the other lines
struct Counted {
  std::uint64_t missing = 0;
  std::vector<std::string> lines;
};
Counted counted(const std::string& text) {
  Counted all;
  for (const std::string& line : lines_of(text)) {
    constexpr std::string_view kMark = "limber: warning: ";
    if (line.starts_with(kMark)) {
      all.missing += std::stoull(line.substr(kMark.size()));
    } else {
      all.lines.push_back(line);
    }
  }
  return all;
}

TEST(TextQueue, ReturnsTextsInOrderAcrossTheEndOfItsBlock) {
  TextQueue queue(1000, 20);
  std::deque<std::pair<std::string, std::uint64_t>> expected;
  Random random(1, "text_queue");
  std::uint64_t order = 0;
  for (int i = 0; i < 20000; i++) {
    const std::string text(1 + random.next() % 300, static_cast<char>('a' + i % 26));
    std::size_t used = 0;
    for (const auto& [each, missing] : expected) used += each.size();
    ASSERT_EQ(queue.fits(text.size()), expected.size() < 20 && used + text.size() <= 1000);
    ASSERT_EQ(queue.half_empty(), expected.size() <= 10 && used <= 500);
    if (queue.fits(text.size())) {
      queue.push(text, order, order % 7);
      expected.emplace_back(text, order++ % 7);
    }
    if (random.next() % 2 == 0 && !expected.empty()) {
      ASSERT_EQ(queue.front_order(), order - expected.size());
      std::string popped;
      ASSERT_EQ(queue.pop(popped), expected.front().second);
      ASSERT_EQ(popped, expected.front().first);
      expected.pop_front();
    }
    ASSERT_EQ(queue.empty(), expected.empty());
  }
}

TEST(OutputWriter, WritesEverythingInOrder) {
  Device a, b;
  std::vector<OutputStream> streams;
  streams.push_back(stream(a));
  streams.push_back(stream(b));
  OutputWriter writer(std::move(streams));
  writer.write(0, "before the start\n");
  ASSERT_TRUE(writer.start());
  std::string expected = "before the start\n";
  for (int i = 0; i < 1000; i++) {
    writer.write(0, fmt::format("line {}\n", i));
    writer.write(1, fmt::format("other {}\n", i));
    expected += fmt::format("line {}\n", i);
  }
  ASSERT_TRUE(writer.drain(0, kForever));
  ASSERT_TRUE(writer.drain(1, kForever));
  EXPECT_EQ(a.got(), expected);
  EXPECT_EQ(lines_of(b.got()).back(), "other 999");
  EXPECT_EQ(writer.lost(0) + writer.lost(1), 0U);
}

TEST(OutputWriter, KeepsTheOrderBetweenDevicesThatAreReady) {
  Device both;  // as `2>&1`
  std::vector<OutputStream> streams;
  streams.push_back(stream(both));
  streams.push_back(stream(both));
  OutputWriter writer(std::move(streams));
  std::string expected;
  for (int i = 0; i < 500; i++) {
    const std::string line = fmt::format("{}\n", i);
    writer.write(i % 3 == 0 ? 1 : 0, line);
    expected += line;
  }
  ASSERT_TRUE(writer.start());
  ASSERT_TRUE(writer.drain(0, kForever));
  ASSERT_TRUE(writer.drain(1, kForever));
  EXPECT_EQ(both.got(), expected);
}

TEST(OutputWriter, DropsAndCountsWhatADeviceThatIsNotReadyCannotTake) {
  for (const Device::State state : {Device::State::not_ready, Device::State::stuck}) {
    Device device;
    device.set(state);
    OutputWriter writer(one(stream(device)), 10000, 100);
    ASSERT_TRUE(writer.start());
    for (int i = 0; i < 5000; i++) writer.write(0, fmt::format("line {}\n", i));  // a hang here is the failure
    EXPECT_FALSE(writer.drain(0, 1ms));
    const std::uint64_t lost = writer.lost(0);
    EXPECT_GE(lost, 4899U);
    EXPECT_LE(lost, 4900U) << "100 in the queue, and perhaps one at the device";
    device.set(Device::State::ready);
    ASSERT_TRUE(writer.drain(0, kForever));
    writer.write(0, "end\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    const Counted got = counted(device.got());
    EXPECT_EQ(got.missing, lost);
    ASSERT_EQ(got.lines.size(), 5001 - lost);
    for (std::size_t i = 0; i + 1 < got.lines.size(); i++) EXPECT_EQ(got.lines[i], fmt::format("line {}", i));
    EXPECT_EQ(got.lines.back(), "end");
  }
}

TEST(OutputWriter, BoundsTheBytesThatWait) {
  Device device;
  device.set(Device::State::not_ready);
  OutputWriter writer(one(stream(device)), 10000, 1000);
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 50; i++) writer.write(0, std::string(999, 'x') + "\n");
  EXPECT_GE(writer.lost(0), 39U);
  device.set(Device::State::ready);
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(counted(device.got()).missing, writer.lost(0));
}

TEST(OutputWriter, CountsWhatADeviceRefuses) {
  for (const int error : {ENOSPC, EPIPE, EBADF, EIO}) {
    Device device;
    std::atomic<int> reported = 0, reports = 0;
    std::atomic<std::uint64_t> gap = 0;
    OutputStream made = stream(device);
    made.on_loss = [&](int e) { reported = e, reports++; };
    made.on_gap = [&](std::uint64_t lines) { gap += lines; };
    OutputWriter writer(one(std::move(made)));
    ASSERT_TRUE(writer.start());
    writer.write(0, "first\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    device.fail(error);
    for (int i = 0; i < 20; i++) writer.write(0, "lost\n");
    ASSERT_TRUE(writer.drain(0, kForever)) << "a failure is no reason to wait";
    EXPECT_EQ(writer.lost(0), 20U);
    EXPECT_EQ(reported, error);
    EXPECT_EQ(reports, 1) << "once, not for every line";
    device.fail(0);
    writer.write(0, "again\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    EXPECT_EQ(device.got(),
              "first\nlimber: warning: 20 lines are missing here: nothing took text at that time\nagain\n");
    EXPECT_EQ(gap, 20U);
  }
}

TEST(OutputWriter, EndsALineThatWasCutOffBeforeTheNextOne) {
  Device device;
  device.set_most(3);
  device.fail(ENOSPC, 3);
  OutputWriter writer(one(stream(device)));
  ASSERT_TRUE(writer.start());
  writer.write(0, "abcdef\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  device.fail(0);
  writer.write(0, "next\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(device.got(), "abc\nlimber: warning: 1 line is missing here: nothing took text at that time\nnext\n");
}

TEST(OutputWriter, ADeviceThatIsNotReadyDoesNotDelayTheOther) {
  Device dead, live;
  dead.set(Device::State::not_ready);
  std::vector<OutputStream> streams;
  streams.push_back(stream(dead));
  streams.push_back(stream(live));
  OutputWriter writer(std::move(streams));
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 300; i++) {
    writer.write(0, "for the dead one\n");
    writer.write(1, fmt::format("{}\n", i));
  }
  ASSERT_TRUE(writer.drain(1, kForever));
  EXPECT_EQ(lines_of(live.got()).size(), 300U);
  EXPECT_EQ(dead.got(), "");
}

TEST(OutputWriter, ASlowDeviceGetsWholeLines) {
  Device device;
  device.set_most(1);
  OutputWriter writer(one(stream(device)));
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 100; i++) writer.write(0, fmt::format("line number {}\n", i));
  ASSERT_TRUE(writer.drain(0, kForever));
  const std::vector<std::string> lines = lines_of(device.got());
  ASSERT_EQ(lines.size(), 100U);
  EXPECT_EQ(lines[99], "line number 99");
}

TEST(OutputWriter, WaitingLosesNothing) {
  for (const auto full : {OutputStream::Full::wait, OutputStream::Full::wait_while}) {
    Device device;
    OutputWriter writer(one(stream(device, full)), 256 << 10, 8);
    ASSERT_TRUE(writer.start());
    std::vector<std::thread> threads;
    threads.reserve(3);
    for (int t = 0; t < 3; t++) {
      threads.emplace_back([&, t] {
        for (int i = 0; i < 300; i++) writer.write(0, fmt::format("{} {}\n", t, i));
      });
    }
    for (std::thread& thread : threads) thread.join();
    const std::string large(300000, 'y');
    writer.write(0, large + "\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    EXPECT_EQ(writer.lost(0), 0U);
    std::vector<std::string> lines = lines_of(device.got());
    ASSERT_EQ(lines.size(), 901U);
    EXPECT_EQ(lines.back(), large);
    int next[3] = {};
    lines.pop_back();
    for (const std::string& line : lines) {
      const int thread = line[0] - '0';
      ASSERT_EQ(line, fmt::format("{} {}", thread, next[thread]++)) << "each thread's lines in their order";
    }
  }
}

TEST(OutputWriter, WaitingEndsWhenTheProgramHurries) {
  Device device;
  device.set(Device::State::not_ready);
  OutputWriter writer(one(stream(device, OutputStream::Full::wait)), 1000, 4);
  ASSERT_TRUE(writer.start());
  std::atomic<int> done = 0;
  std::thread caller([&] {
    for (int i = 0; i < 100; i++) {
      writer.write(0, "line\n");
      done++;
    }
  });
  while (done < 4) std::this_thread::yield();
  EXPECT_LE(done, 5) << "it waits";
  writer.hurry();
  caller.join();
  EXPECT_FALSE(writer.drain(0, kForever)) << "nor does the end wait for long";
  EXPECT_GE(writer.lost(0), 95U);
}

TEST(OutputWriter, WaitingEndsWhereADeviceTakesNothing) {
  Device device;
  device.set(Device::State::not_ready);
  OutputWriter writer(one(stream(device, OutputStream::Full::wait_while)), 1000, 4);
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 1000; i++) writer.write(0, "line\n");  // waits once, not a thousand times
  EXPECT_GE(writer.lost(0), 995U);
  device.set(Device::State::ready);
  ASSERT_TRUE(writer.drain(0, kForever));
  writer.write(0, "end\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(counted(device.got()).missing, writer.lost(0));
}

TEST(OutputWriter, ShortensALineThatIsTooLong) {
  Device device;
  OutputWriter writer(one(stream(device)));
  ASSERT_TRUE(writer.start());
  writer.write(0, "begin" + std::string(1000000, 'z') + "end\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  const std::vector<std::string> lines = lines_of(device.got());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT(lines[0].size(), OutputWriter::kLongest);
  EXPECT_TRUE(lines[0].starts_with("beginz") && lines[0].ends_with("zend"));
  EXPECT_EQ(writer.lost(0), 0U);
}

TEST(OutputWriter, ItsReportsMayBeWrittenByItself) {
  Device device;
  OutputWriter* self = nullptr;
  OutputStream made = stream(device, OutputStream::Full::wait);
  made.counts = false;
  made.on_loss = [&](int) { self->write(0, "report\n"); };
  made.on_gap = [&](std::uint64_t lines) { self->write(0, fmt::format("{} lost\n", lines)); };
  OutputWriter writer(one(std::move(made)), 1000, 2);
  self = &writer;
  ASSERT_TRUE(writer.start());
  device.fail(ENOSPC);
  for (int i = 0; i < 10; i++) writer.write(0, "lost\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  device.fail(0);
  writer.write(0, "again\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(device.got(), fmt::format("again\n{} lost\n", writer.lost(0)));
}

}  // namespace
}  // namespace limber
