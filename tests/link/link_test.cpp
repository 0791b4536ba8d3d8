// Ableton Link: the lines of limber-link, what is sent to the show and to the session, and two programs in a session in
// a network namespace of the test's own.
#include <gtest/gtest.h>

#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <semaphore>
#include <thread>

#include "base/log/log.h"
#include "base/system/file.h"
#include "base/system/net/udp_socket.h"
#include "base/system/wait.h"
#include "net/link/link_session.h"
#include "support/skip.h"

namespace limber::link {
namespace {

using sim::ClockReading;

TEST(LinkLine, IsFiveNumbers) {
  const std::optional<LinkLine> line = parse_link_line("-3.25 123.5 1 2 1056.75");
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(line->beat, -3.25);
  EXPECT_EQ(line->tempo, 123.5);
  EXPECT_TRUE(line->playing);
  EXPECT_EQ(line->peers, 2u);
  EXPECT_EQ(line->time, 1056.75);
  for (const char* wrong : {"", "1", "1 2 3 4", "1 120 1 2 3 4", "1 x 0 0 0", "nan 120 0 0 0", "1 0 0 0 0",
                            "1 120 0 -1 0", "1 120 0 1e9 0", "1  120 0 0 0"})
    EXPECT_FALSE(parse_link_line(wrong)) << wrong;
}

std::string addresses(const std::vector<Message>& messages) {
  std::string text;
  for (const Message& message : messages) {
    text += message.address;
    for (const Arg& arg : message.args) text += " " + std::to_string(static_cast<int>(arg.number * 100));
    text += ";";
  }
  return text;
}

TEST(LinkTranslator, TheShowFollowsTheSession) {
  LinkTranslator translator;
  const ClockReading clock;
  EXPECT_EQ(addresses(translator.messages({1.5, 90, false, 0, 7}, clock)), "/clock/sync 150 9000 700;")
      << "a session that doesn't play doesn't stop the show";
  EXPECT_EQ(addresses(translator.messages({2, 90, true, 0, 8}, clock)), "/clock/sync 200 9000 800;")
      << "it plays already";
  EXPECT_EQ(addresses(translator.messages({3, 90, false, 0, 9}, clock)), "/clock/sync 300 9000 900;/clock/playing 0;");
  ClockReading stopped;
  stopped.playing = false;
  EXPECT_EQ(addresses(translator.messages({0, 90, true, 0, 9}, stopped)), "/clock/sync 0 9000 900;/clock/playing 100;");
}

TEST(LinkTranslator, TheSessionFollowsThePerformer) {
  LinkTranslator translator;
  ClockReading clock;
  EXPECT_EQ(translator.lines(clock, 10), "");
  clock.set_tempo = 133;
  EXPECT_EQ(translator.lines(clock, 11), "tempo 133\n");
  EXPECT_EQ(translator.lines(clock, 12), "");
  clock.tempo = 99;
  EXPECT_EQ(translator.lines(clock, 13), "") << "the tempo of the session itself";
  clock.beats_per_bar = 3;
  clock.playing = false;
  EXPECT_EQ(translator.lines(clock, 14), "bar 3\nplaying 0\n");
  clock.set_tempo = 120;
  clock.playing = true;
  EXPECT_EQ(translator.lines(clock, 2), "") << "a reset, or another scene";
  translator.messages({0, 120, true, 0, 0}, clock);
  clock.playing = false;
  translator.messages({0, 120, false, 0, 0}, clock);
  EXPECT_EQ(translator.lines(clock, 3), "") << "the session has stopped the show";
}

// A program in place of limber-link.
class FakeProgram {
 public:
  explicit FakeProgram(const std::string& script) {
    std::ofstream(path_) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all);
  }
  ~FakeProgram() { std::filesystem::remove(path_); }
  FakeProgram(const FakeProgram&) = delete;
  FakeProgram& operator=(const FakeProgram&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_ = testing::TempDir() + "limber_link_" + std::to_string(getpid());
};

void publish_clock(engine::EngineLink& link, double tempo) {
  const std::shared_ptr<engine::Snapshot> snapshot = link.snapshots.acquire_buffer();
  *snapshot = {};
  snapshot->clock.tempo = tempo;
  link.snapshots.publish(snapshot);
}

TEST(LinkSession, ReadsTheLinesOfItsProgram) {
  const FakeProgram program("echo nonsense; echo \"4.5 $1 0 $2 1\"; read line");
  engine::EngineLink link;
  std::counting_semaphore<> sent{0};
  link.wake_engine = [&] { sent.release(); };
  publish_clock(link, 101);
  LinkSession session(link, program.path());
  session.start();
  ASSERT_TRUE(sent.try_acquire_for(std::chrono::minutes(1)));
  session.stop();
  std::vector<engine::Command> commands;
  link.command_queue.drain(commands);
  ASSERT_FALSE(commands.empty());
  EXPECT_EQ(addresses(commands[0].messages), "/clock/sync 450 10100 100;");
}

TEST(LinkSession, AMissingProgramIsReportedOnceWithACorrection) {
  log_to_stderr(false);
  engine::EngineLink link;
  publish_clock(link, 100);
  LinkSession session(link, "/none/limber-link");
  const std::uint64_t before = log_newest();
  session.start();
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (log_newest() == before && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
  session.stop();
  const std::vector<LogLine> lines = log_since(before);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].text,
            "Link: /none/limber-link has ended or can't be started: No such file or directory. It is built with Limber "
            "if the package ableton-link-dev is installed; trying again every 5 seconds");
  log_to_stderr(true);
}

enum Result : int { passed, no_namespace, not_started, not_found, other_tempo, other_phase };

bool enable_loopback() {
  const system::UdpSocket socket = std::move(system::open_udp({0, 0}).value());
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_MULTICAST;
  return ioctl(socket.fd(), SIOCSIFFLAGS, &request) == 0;
}

// The newest line of a program, after waiting for one.
std::optional<LinkLine> newest_line(const system::ChildProcess& process) {
  std::array<char, 4096> bytes;
  const std::ptrdiff_t count = system::read_some(process.output(), bytes.data(), bytes.size());
  if (count <= 0) return std::nullopt;
  std::string_view text(bytes.data(), static_cast<std::size_t>(count));
  if (text.ends_with('\n')) text.remove_suffix(1);
  return parse_link_line(text.substr(text.rfind('\n') + 1));
}

// A child process runs it, with one thread. Each line takes 50 ms.
int play_in_own_namespace(const std::string& program) {
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 || !enable_loopback()) return no_namespace;
  system::ChildProcess first;
  system::ChildProcess second;
  if (first.start_quietly({program, "120", "4"}) != 0 || second.start_quietly({program, "95", "4"}) != 0)
    return not_started;
  constexpr int kMaxLines = 1200;
  std::optional<LinkLine> a;
  std::optional<LinkLine> b;
  const auto wait_until = [&](auto&& condition) {
    for (int i = 0; i < kMaxLines; i++) {
      a = newest_line(first);
      b = newest_line(second);
      if (a && b && condition()) return true;
    }
    return false;
  };
  if (!wait_until([&] { return a->peers == 1 && b->peers == 1; })) return not_found;
  if (!first.write("tempo 140\n")) return not_started;
  if (!wait_until([&] { return std::abs(a->tempo - 140) < 0.01 && std::abs(b->tempo - 140) < 0.01; }))
    return other_tempo;
  // both count from the same beat, modulo a bar
  const auto difference = [&] {
    const double beats = b->beat - a->beat - (b->time - a->time) * 140 / 60;
    return std::abs(beats - 4 * std::round(beats / 4)) * 60 / 140;  // s
  };
  return wait_until([&] { return difference() < 1e-3; }) ? passed : other_phase;
}

TEST(LinkSession, TwoProgramsShareTempoAndPhase) {
  const std::string program = std::filesystem::path(LIMBER_PROGRAM).parent_path() / "limber-link";
  LIMBER_SKIP_IF(!std::filesystem::exists(program), "limber-link is not part of this build");
  const pid_t child = fork();
  if (child == 0) _exit(play_in_own_namespace(program));
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  LIMBER_SKIP_IF(WEXITSTATUS(status) == no_namespace, "this machine permits no network namespaces");
  EXPECT_EQ(WEXITSTATUS(status), passed);
}

}  // namespace
}  // namespace limber::link
