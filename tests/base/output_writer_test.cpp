// OutputWriter with devices that are full, not ready, closed, slow or stuck: callers are not blocked, lost lines are
// counted, and lines stay complete.
#include "base/log/output_writer.h"

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

// A device with a state that the test controls.
class Device {
 public:
  enum class State { ready, not_ready, stuck };

  void set(State state) {
    const std::scoped_lock lock(mutex_);
    state_ = state;
    changed_.notify_all();
  }
  /// Fails after this number of bytes; 0: never.
  void fail(int error, std::size_t from = 0) {
    const std::scoped_lock lock(mutex_);
    error_ = error;
    fails_from_ = from;
  }
  /// Accepts at most this many bytes per call.
  void set_max_bytes(std::size_t bytes) { max_bytes_ = bytes; }
  std::string received() const {
    const std::scoped_lock lock(mutex_);
    return received_;
  }
  system::Written write(std::string_view bytes) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return state_ != State::stuck; });
    if (state_ == State::not_ready) return {0, EAGAIN};
    if (error_ != 0 && received_.size() >= fails_from_) return {0, error_};
    const std::string_view accepted = bytes.substr(0, max_bytes_);
    received_ += accepted;
    return {accepted.size(), 0};
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::ready;
  int error_ = 0;
  std::size_t fails_from_ = 0;
  std::size_t max_bytes_ = 4096;
  std::string received_;
};

struct DeviceAdapter : OutputDevice {
  explicit DeviceAdapter(Device& adapted) : device(adapted) {}
  system::Written write(std::string_view bytes, std::chrono::nanoseconds) override { return device.write(bytes); }
  Device& device;
};

OutputStream stream(Device& device, OutputStream::Full full = OutputStream::Full::drop) {
  OutputStream result;
  result.device = std::make_unique<DeviceAdapter>(device);
  result.full = full;
  return result;
}

std::vector<OutputStream> single_stream(OutputStream output) {
  std::vector<OutputStream> list;
  list.push_back(std::move(output));
  return list;
}

constexpr auto kForever = std::nullopt;

// Splits "a\nb\n" into {"a", "b"}. An incomplete line is a failure.
std::vector<std::string> lines_of(const std::string& text) {
  EXPECT_TRUE(text.empty() || text.ends_with('\n'))
      << text.substr(text.size() - std::min<std::size_t>(80, text.size()));
  std::vector<std::string> lines;
  for (const std::string_view line : split(text, '\n')) lines.emplace_back(line);
  lines.pop_back();
  return lines;
}

// The numbers in the notices about missing lines, and the other lines.
struct ParsedOutput {
  std::uint64_t missing = 0;
  std::vector<std::string> lines;
};
ParsedOutput parse_output(const std::string& text) {
  ParsedOutput result;
  for (const std::string& line : lines_of(text)) {
    constexpr std::string_view kPrefix = "limber: warning: ";
    if (line.starts_with(kPrefix)) {
      result.missing += std::stoull(line.substr(kPrefix.size()));
    } else {
      result.lines.push_back(line);
    }
  }
  return result;
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
  EXPECT_EQ(a.received(), expected);
  EXPECT_EQ(lines_of(b.received()).back(), "other 999");
  EXPECT_EQ(writer.lost(0) + writer.lost(1), 0U);
}

TEST(OutputWriter, KeepsTheOrderBetweenReadyDevices) {
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
  EXPECT_EQ(both.received(), expected);
}

TEST(OutputWriter, DropsAndCountsLinesOfABlockedDevice) {
  for (const Device::State state : {Device::State::not_ready, Device::State::stuck}) {
    Device device;
    device.set(state);
    OutputWriter writer(single_stream(stream(device)), 10000, 100);
    ASSERT_TRUE(writer.start());
    for (int i = 0; i < 5000; i++) writer.write(0, fmt::format("line {}\n", i));  // the test fails if this blocks
    EXPECT_FALSE(writer.drain(0, 1ms));
    const std::uint64_t lost = writer.lost(0);
    EXPECT_GE(lost, 4899U);
    EXPECT_LE(lost, 4900U) << "100 in the queue, and perhaps one at the device";
    device.set(Device::State::ready);
    ASSERT_TRUE(writer.drain(0, kForever));
    writer.write(0, "end\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    const ParsedOutput parsed = parse_output(device.received());
    EXPECT_EQ(parsed.missing, lost);
    ASSERT_EQ(parsed.lines.size(), 5001 - lost);
    for (std::size_t i = 0; i + 1 < parsed.lines.size(); i++) EXPECT_EQ(parsed.lines[i], fmt::format("line {}", i));
    EXPECT_EQ(parsed.lines.back(), "end");
  }
}

TEST(OutputWriter, LimitsQueuedBytes) {
  Device device;
  device.set(Device::State::not_ready);
  OutputWriter writer(single_stream(stream(device)), 10000, 1000);
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 50; i++) writer.write(0, std::string(999, 'x') + "\n");
  EXPECT_GE(writer.lost(0), 39U);
  device.set(Device::State::ready);
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(parse_output(device.received()).missing, writer.lost(0));
}

TEST(OutputWriter, CountsLinesOfAFailingDevice) {
  for (const int error : {ENOSPC, EPIPE, EBADF, EIO}) {
    Device device;
    std::atomic<int> reported = 0, reports = 0;
    std::atomic<std::uint64_t> gap = 0;
    OutputStream output = stream(device);
    output.on_loss = [&](int e) { reported = e, reports++; };
    output.on_gap = [&](std::uint64_t lines) { gap += lines; };
    OutputWriter writer(single_stream(std::move(output)));
    ASSERT_TRUE(writer.start());
    writer.write(0, "first\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    device.fail(error);
    for (int i = 0; i < 20; i++) writer.write(0, "lost\n");
    ASSERT_TRUE(writer.drain(0, kForever)) << "does not wait after a failure";
    EXPECT_EQ(writer.lost(0), 20U);
    EXPECT_EQ(reported, error);
    EXPECT_EQ(reports, 1) << "once, not for every line";
    device.fail(0);
    writer.write(0, "again\n");
    ASSERT_TRUE(writer.drain(0, kForever));
    EXPECT_EQ(device.received(), "first\nlimber: warning: 20 lines are missing here: the output was blocked\nagain\n");
    EXPECT_EQ(gap, 20U);
  }
}

TEST(OutputWriter, EndsAnInterruptedLine) {
  Device device;
  device.set_max_bytes(3);
  device.fail(ENOSPC, 3);
  OutputWriter writer(single_stream(stream(device)));
  ASSERT_TRUE(writer.start());
  writer.write(0, "abcdef\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  device.fail(0);
  writer.write(0, "next\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(device.received(), "abc\nlimber: warning: 1 line is missing here: the output was blocked\nnext\n");
}

TEST(OutputWriter, BlockedDeviceDoesNotDelayOthers) {
  Device blocked, ready;
  blocked.set(Device::State::not_ready);
  std::vector<OutputStream> streams;
  streams.push_back(stream(blocked));
  streams.push_back(stream(ready));
  OutputWriter writer(std::move(streams));
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 300; i++) {
    writer.write(0, "for the blocked device\n");
    writer.write(1, fmt::format("{}\n", i));
  }
  ASSERT_TRUE(writer.drain(1, kForever));
  EXPECT_EQ(lines_of(ready.received()).size(), 300U);
  EXPECT_EQ(blocked.received(), "");
}

TEST(OutputWriter, ASlowDeviceGetsWholeLines) {
  Device device;
  device.set_max_bytes(1);
  OutputWriter writer(single_stream(stream(device)));
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 100; i++) writer.write(0, fmt::format("line number {}\n", i));
  ASSERT_TRUE(writer.drain(0, kForever));
  const std::vector<std::string> lines = lines_of(device.received());
  ASSERT_EQ(lines.size(), 100U);
  EXPECT_EQ(lines[99], "line number 99");
}

TEST(OutputWriter, WaitingLosesNothing) {
  for (const auto full : {OutputStream::Full::wait, OutputStream::Full::wait_while}) {
    Device device;
    OutputWriter writer(single_stream(stream(device, full)), 256 << 10, 8);
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
    std::vector<std::string> lines = lines_of(device.received());
    ASSERT_EQ(lines.size(), 901U);
    EXPECT_EQ(lines.back(), large);
    int next[3] = {};
    lines.pop_back();
    for (const std::string& line : lines) {
      const int thread = line[0] - '0';
      ASSERT_EQ(line, fmt::format("{} {}", thread, next[thread]++)) << "lines of a thread are in order";
    }
  }
}

TEST(OutputWriter, WaitingEndsOnShutdown) {
  Device device;
  device.set(Device::State::not_ready);
  OutputWriter writer(single_stream(stream(device, OutputStream::Full::wait)), 1000, 4);
  ASSERT_TRUE(writer.start());
  std::atomic<int> done = 0;
  std::thread caller([&] {
    for (int i = 0; i < 100; i++) {
      writer.write(0, "line\n");
      done++;
    }
  });
  while (done < 4) std::this_thread::yield();
  EXPECT_LE(done, 5) << "write() blocks";
  writer.begin_shutdown();
  caller.join();
  EXPECT_FALSE(writer.drain(0, kForever)) << "drain() stops waiting, too";
  EXPECT_GE(writer.lost(0), 95U);
}

TEST(OutputWriter, WaitingEndsIfADeviceStalls) {
  Device device;
  device.set(Device::State::not_ready);
  OutputWriter writer(single_stream(stream(device, OutputStream::Full::wait_while)), 1000, 4);
  ASSERT_TRUE(writer.start());
  for (int i = 0; i < 1000; i++) writer.write(0, "line\n");  // waits once, not 1000 times
  EXPECT_GE(writer.lost(0), 995U);
  device.set(Device::State::ready);
  ASSERT_TRUE(writer.drain(0, kForever));
  writer.write(0, "end\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(parse_output(device.received()).missing, writer.lost(0));
}

TEST(OutputWriter, ShortensLongLines) {
  Device device;
  OutputWriter writer(single_stream(stream(device)));
  ASSERT_TRUE(writer.start());
  writer.write(0, "begin" + std::string(1000000, 'z') + "end\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  const std::vector<std::string> lines = lines_of(device.received());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT(lines[0].size(), OutputWriter::kMaxTextBytes);
  EXPECT_TRUE(lines[0].starts_with("beginz") && lines[0].ends_with("zend"));
  EXPECT_EQ(writer.lost(0), 0U);
}

TEST(OutputWriter, CallbacksMayWriteToTheSameWriter) {
  Device device;
  OutputWriter* self = nullptr;
  OutputStream output = stream(device, OutputStream::Full::wait);
  output.inserts_notice = false;
  output.on_loss = [&](int) { self->write(0, "report\n"); };
  output.on_gap = [&](std::uint64_t lines) { self->write(0, fmt::format("{} lost\n", lines)); };
  OutputWriter writer(single_stream(std::move(output)), 1000, 2);
  self = &writer;
  ASSERT_TRUE(writer.start());
  device.fail(ENOSPC);
  for (int i = 0; i < 10; i++) writer.write(0, "lost\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  device.fail(0);
  writer.write(0, "again\n");
  ASSERT_TRUE(writer.drain(0, kForever));
  EXPECT_EQ(device.received(), fmt::format("again\n{} lost\n", writer.lost(0)));
}

}  // namespace
}  // namespace limber
