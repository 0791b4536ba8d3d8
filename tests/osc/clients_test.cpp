// Real clients: liblo's oscsend sends to a running Network and its oscdump reads the streams.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "net/osc/network.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

// A child process with readable output; it is killed by the destructor.
class Child {
 public:
  explicit Child(std::vector<std::string> words) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    // all allocations happen before the fork: other threads may hold the allocator's lock
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& w : words) arguments.push_back(w.data());
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      execvp(arguments[0], arguments.data());
      _exit(127);
    }
    close(ends[1]);
    output_ = system::Descriptor(ends[0]);
  }
  ~Child() { end(); }

  /// Returns the exit status; kills the child after a timeout.
  int status() {
    pollfd p{output_.fd(), POLLIN, 0};
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
    std::array<char, 4096> skipped{};
    while (std::chrono::steady_clock::now() < until && poll(&p, 1, kTimeoutMs) > 0) {
      if (read(output_.fd(), skipped.data(), skipped.size()) <= 0) break;
    }
    if (std::chrono::steady_clock::now() >= until) kill(pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Returns the next line of output, or an empty string on timeout.
  std::string line() {
    while (text_.find('\n') == std::string::npos) {
      pollfd p{output_.fd(), POLLIN, 0};
      std::array<char, 4096> more{};
      if (poll(&p, 1, kTimeoutMs) <= 0) return {};
      const auto size = read(output_.fd(), more.data(), more.size());
      if (size <= 0) return {};
      text_.append(more.data(), static_cast<std::size_t>(size));
    }
    const std::size_t at = text_.find('\n');
    std::string first = text_.substr(0, at);
    text_.erase(0, at + 1);
    return first;
  }
  void end() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

 private:
  pid_t pid_ = -1;
  system::Descriptor output_;
  std::string text_;
};

OscOptions options_to_port(std::uint16_t port) {
  OscOptions options;
  options.in = *parse_osc_in("0");
  options.out = *parse_osc_out("127.0.0.1:" + std::to_string(port) + ",rate=100,streams=pos+rot");
  return options;
}

TEST(Clients, OscsendControlsTheScene) {
  FakeEngine engine;
  Network network(engine.link, options_to_port(9), kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  const std::string url = "osc.udp://127.0.0.1:" + std::to_string(network.bound().at(0).port);
  EXPECT_EQ(Child({"oscsend", url, "/physics/part/mass", "ssf", "quadruped", "foot_1", "0.25"}).status(), 0);
  ASSERT_TRUE(engine.wait_for(1));
  const Message& mass = engine.commands.at(0).messages.at(0);
  EXPECT_EQ(mass.address, "/physics/part/mass");
  ASSERT_EQ(mass.args.size(), 3u);
  EXPECT_EQ(mass.args[0].text, "quadruped");
  EXPECT_EQ(mass.args[1].text, "foot_1");
  EXPECT_EQ(mass.args[2].number, 0.25);

  EXPECT_EQ(Child({"oscsend", url, "/tags", "ihdTFNIcS", "-7", "123456789012", "0.1", "q", "word"}).status(), 0);
  ASSERT_TRUE(engine.wait_for(2));
  const std::vector<Arg>& a = engine.commands.at(1).messages.at(0).args;
  ASSERT_EQ(a.size(), 9u);
  EXPECT_EQ(a[0].number, -7);
  EXPECT_EQ(a[1].number, 123456789012.0);
  EXPECT_EQ(a[2].number, 0.1);
  EXPECT_EQ(a[3].number, 1);
  EXPECT_EQ(a[4].kind, Arg::Kind::boolean);
  EXPECT_EQ(a[5].kind, Arg::Kind::nil);
  EXPECT_EQ(a[7].text, "q");
  EXPECT_EQ(a[8].text, "word");
}

TEST(Clients, OscsendControlsTheSceneByTcp) {
  FakeEngine engine;
  OscOptions options = options_to_port(9);
  options.tcp = *parse_listen("--osc-tcp", "0");
  Network network(engine.link, options, kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  const std::string url = "osc.tcp://127.0.0.1:" + std::to_string(network.bound_tcp().at(0).port) + "/";
  EXPECT_EQ(Child({"oscsend", url, "/physics/part/mass", "ssf", "quadruped", "foot_1", "0.25"}).status(), 0);
  ASSERT_TRUE(engine.wait_for(1));
  const Message& mass = engine.commands.at(0).messages.at(0);
  EXPECT_EQ(mass.address, "/physics/part/mass");
  ASSERT_EQ(mass.args.size(), 3u);
  EXPECT_EQ(mass.args[2].number, 0.25);
}

TEST(Clients, OscdumpReceivesTheStreams) {
  // a port that is currently free; oscdump opens it shortly after
  const std::uint16_t port = Client().end().port;
  Child dump({"stdbuf", "-oL", "oscdump", "-L", std::to_string(port)});
  FakeEngine engine;
  engine::Snapshot world = test_world({{"arm", 1}});
  for (std::size_t i = 0; i < world.transient.size(); i++) world.transient[i] = static_cast<double>(i) / 4;
  const auto spare = engine.link.snapshots.acquire_buffer();
  *spare = world;
  engine.link.snapshots.publish(spare);
  Network network(engine.link, options_to_port(port), kTestOffsets);
  ASSERT_TRUE(network.start().ok());
  // each number is a quarter of its index: position at 1, rotation at 4
  for (int i = 0; i < 10; i++) {
    const std::string line = dump.line();
    const bool pos = line.find("/physics/joint/pos sfff \"arm\" 0.250000 0.500000 0.750000") != std::string::npos;
    const bool rot =
        line.find("/physics/joint/rot sffff \"arm\" 1.000000 1.250000 1.500000 1.750000") != std::string::npos;
    EXPECT_TRUE(pos || rot) << line;
  }
}

}  // namespace
}  // namespace limber::osc
