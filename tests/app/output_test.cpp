// Outputs that are full, closed or not read: a show plays on and ends at a signal, and a lost result is an error.
#include <sys/stat.h>
#include <termios.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "app/playing.h"

namespace limber::app::test {
namespace {

// runs the program with its outputs redirected by a shell: "2>/dev/full"
std::vector<std::string> redirected(const std::string& to, std::vector<std::string> words) {
  words.insert(words.begin(), {"sh", "-c", "exec \"$@\" " + to, "sh"});
  return words;
}

RunResult run_redirected(const std::string& to, std::vector<std::string> args) {
  return Process(redirected(to, limber_command(std::move(args)))).finish();
}

// a full named pipe without a reader
class UnreadPipe {
 public:
  UnreadPipe() : path_(folder_.path() + "/pipe") {
    EXPECT_EQ(mkfifo(path_.c_str(), 0600), 0);
    read_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const int write_end = open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    const std::string bytes(4096, 'x');
    while (write(write_end, bytes.data(), bytes.size()) > 0) {
    }
    close(write_end);
  }
  ~UnreadPipe() { close(read_); }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;
  const std::string& path() const { return path_; }

 private:
  TempFolder folder_;
  std::string path_;
  int read_ = -1;
};

// a terminal with stopped output, as after Ctrl+S
class StoppedTerminal {
 public:
  StoppedTerminal() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_EQ(grantpt(master_) + unlockpt(master_), 0);
    path_ = ptsname(master_);
    slave_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    EXPECT_EQ(tcflow(slave_, TCOOFF), 0);
  }
  ~StoppedTerminal() {
    close(slave_);
    close(master_);
  }
  StoppedTerminal(const StoppedTerminal&) = delete;
  StoppedTerminal& operator=(const StoppedTerminal&) = delete;
  const std::string& path() const { return path_; }

 private:
  int master_;
  int slave_ = -1;
  std::string path_;
};

// prints more than a pipe and the output queue can hold
constexpr const char* kVerboseScene = R"(
for i = 1, 3000 do print(i, ("x"):rep(200)) end
local n = 0
sim:on_step(function()
  n = n + 1
  print("step", n)
  if n % 7 == 0 then warn(("w"):rep(n % 90) .. n) end
end)
)";

// a show in real time with redirected outputs
class RedirectedShow {
 public:
  explicit RedirectedShow(const std::string& to)
      : to_(to),
        environment_{"env", "XDG_RUNTIME_DIR=" + runtime_.path(), "XDG_STATE_HOME=" + (runtime_ / "state")},
        show_(redirected(to, limber_command({"play", folder_.file("scripts/s.lua", kVerboseScene), "--headless",
                                             "--osc-in", "off", "--osc-out", "off", "--query", "off"},
                                            environment_))) {}
  const std::string& to() const { return to_; }
  /// Queries the tick through the console until it is at least `least`.
  double wait_for_tick(double min_tick) const {
    double tick = -1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
    while (tick < min_tick && std::chrono::steady_clock::now() < end) {
      const RunResult asked = Process(limber_command({"console", "-e", "sim.tick"}, environment_)).finish();
      if (asked.code == 0) tick = std::stod(asked.out);
    }
    return tick;
  }
  Process& running() { return show_; }

 private:
  std::string to_;
  TempFolder folder_;
  console::PrivateFolder runtime_;
  std::vector<std::string> environment_;
  Process show_;
};

TEST(Output, ShowPlaysWithBlockedOutputs) {
  const UnreadPipe pipe;
  const StoppedTerminal terminal;
  std::vector<std::unique_ptr<RedirectedShow>> shows;
  for (const std::string& to : {std::string("/dev/full"), std::string("&-"), pipe.path(), terminal.path()}) {
    shows.push_back(std::make_unique<RedirectedShow>("2>" + to));
    shows.push_back(std::make_unique<RedirectedShow>(">" + to));
    if (to != "&-") shows.push_back(std::make_unique<RedirectedShow>(">" + to + " 2>&1"));
  }
  shows.push_back(std::make_unique<RedirectedShow>("<&- >&- 2>&-"));
  std::vector<double> first;
  for (const auto& show : shows) {
    first.push_back(show->wait_for_tick(0));
    ASSERT_GE(first.back(), 0) << show->to() << ": it does not play";
  }
  for (std::size_t i = 0; i < shows.size(); i++)
    ASSERT_GE(shows[i]->wait_for_tick(first[i] + 30), first[i] + 30)
        << shows[i]->to() << ": its ticks wait for the output";
  for (const auto& show : shows) show->running().signal(SIGTERM);
  for (const auto& show : shows) EXPECT_EQ(show->running().finish().code, 0) << show->to();
}

TEST(Output, ClosedPipeDoesNotEndAShow) {
  const TempFolder folder;
  const std::string fifo = folder.path() + "/pipe";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  const int reader = open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const std::string line = fmt::format("\"$0\" play {} --fast --ticks 200 >{} 2>&1; echo code $?",
                                       folder.file("s.lua", kVerboseScene), fifo);
  Process show({"sh", "-c", line, LIMBER_PROGRAM});
  char byte = 0;
  while (read(reader, &byte, 1) != 1) {
  }
  close(reader);
  EXPECT_EQ(show.finish().out, "code 0\n");
}

TEST(Output, LostResultIsAnError) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "print('printed')");
  const std::string robot = LIMBER_SOURCE_DIR "/urdf/arm6.urdf";
  const std::vector<std::vector<std::string>> commands = {{"play", scene, "--fast", "--ticks", "3", "--hash"},
                                                          {"describe"},
                                                          {"describe", "--json"},
                                                          {"describe", "--markdown"},
                                                          {"describe", scene},
                                                          {"annotate"},
                                                          {"man"},
                                                          {"completion", "bash"},
                                                          {"inspect", robot},
                                                          {"--help"},
                                                          {"--version"}};
  for (const std::vector<std::string>& command : commands) {
    SCOPED_TRACE(command.front());
    RunResult result = run_redirected(">/dev/full", command);
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.err.find("limber: standard output can't be written: No space left on device"), std::string::npos)
        << result.err;
    result = run_redirected(">&-", command);
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.err.find("limber: standard output can't be written: Bad file descriptor"), std::string::npos)
        << result.err;
    EXPECT_EQ(run_redirected("2>/dev/full", command).code, 0) << "the log is no result";
    EXPECT_EQ(run_redirected(">/dev/full 2>&1", command).code, 3) << "even if the message can't be printed";
  }
}

TEST(Output, HandlesDevicesInPlaceOfFiles) {
  const RunResult full = run_redirected(">/dev/full", {"annotate", "/dev/stdout"});
  EXPECT_EQ(full.code, 3);
  EXPECT_NE(full.err.find("/dev/stdout can't be written"), std::string::npos) << full.err;
  const RunResult endless = run({"preset", "import", "/dev/zero"});
  EXPECT_EQ(endless.code, 1);
  EXPECT_NE(endless.err.find("/dev/zero: it is a folder or a device, not a file"), std::string::npos) << endless.err;
}

TEST(Output, ClosedReaderEndsACommandQuietly) {
  for (const char* command : {"describe", "describe --markdown", "man", "annotate"}) {
    const std::string line = fmt::format("(\"$0\" {}; echo \"code $?\" >&2) | head -1", command);
    const RunResult result = Process({"sh", "-c", line, LIMBER_PROGRAM}).finish();
    EXPECT_EQ(result.err, "code 0\n") << command;
    EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1) << command;
  }
}

TEST(Output, BatchRunLosesNoLineToASlowReader) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", "for i = 1, 20000 do print(('%06d'):format(i), ('y'):rep(60)) end");
  const std::string line = fmt::format("\"$0\" play {} --fast --ticks 1 | (sleep 0.3; cat)", scene);
  const RunResult result = Process({"sh", "-c", line, LIMBER_PROGRAM}).finish();
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 20000);
  EXPECT_NE(result.out.find("\n020000\t"), std::string::npos);
  EXPECT_EQ(result.err.find("missing"), std::string::npos) << result.err;
}

TEST(Output, SignalEndsABatchRunThatWaitsForAReader) {
  const TempFolder folder;
  const UnreadPipe pipe;
  const std::string scene = folder.file("s.lua", "for i = 1, 20000 do print(('z'):rep(100)) end");
  for (const char* const hash : {"--strict", "--hash"}) {
    Process batch(redirected(">" + pipe.path(), limber_command({"play", scene, "--fast", "--ticks", "1", hash})));
    ASSERT_TRUE(batch.wait_for("s.lua"));
    batch.signal(SIGTERM);
    EXPECT_NE(batch.finish().code, 128 + SIGTERM);
  }
}

TEST(Output, CommandLineErrorsAreCompleteAndInOrder) {
  const RunResult result =
      run({"play", "--fast", "--set", "no equals sign", std::string(LIMBER_SOURCE_DIR) + "/scripts/arms.lua"});
  EXPECT_EQ(result.code, 2);
  const std::size_t head = result.err.find("limber 0"), fault = result.err.find("limber: --set 'no equals sign'");
  EXPECT_LT(head, fault);
  EXPECT_NE(fault, std::string::npos) << result.err;
  EXPECT_TRUE(result.err.ends_with('\n'));
}

// with 2>&- the first file that was opened used to get descriptor 2
TEST(Output, ClosedOutputsDoNotWriteIntoOtherFiles) {
  const TempFolder folder;
  const std::string scene =
      folder.file("s.lua", "for i = 1, 100 do print('printed') warn('warned ' .. ('x'):rep(i)) end");
  const std::string take = folder.path() + "/s.take";
  EXPECT_EQ(run_redirected("<&- >&- 2>&-", {"play", scene, "--fast", "--ticks", "20", "--record", take}).code, 0);
  const RunResult info = run({"take", "info", take});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("complete"), std::string::npos) << info.out;
  EXPECT_EQ(content(take).find("limber: warning"), std::string::npos);
}

}  // namespace
}  // namespace limber::app::test
