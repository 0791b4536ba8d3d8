// `limber service`, and the messages to the service manager while a show plays.
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstring>

#include "app/playing.h"
#include "app/service/service_unit.h"

namespace limber::app::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kServedScene = "sim:on_step(function() end)\n";

std::string unit_path(const TempFolder& home, const std::string& name) {
  return home.path() + "/systemd/user/limber-" + name + ".service";
}

RunResult run_service(const TempFolder& home, std::vector<std::string> args, const std::string& folder) {
  args.insert(args.begin(), "service");
  return Process(limber_command(std::move(args), {"env", "XDG_CONFIG_HOME=" + home.path()}), folder).finish();
}

TEST(ServiceUnit, QuotesWhatSystemdWouldExpand) {
  EXPECT_EQ(unit_word("--osc-in"), "--osc-in");
  EXPECT_EQ(unit_word("a b"), "\"a b\"");
  EXPECT_EQ(unit_word(""), "\"\"");
  EXPECT_EQ(unit_word("50%h $HOME"), "\"50%%h $$HOME\"");
  EXPECT_EQ(unit_word("a\"b\\c"), "\"a\\\"b\\\\c\"");
  EXPECT_EQ(unit_word("a\nb"), "\"a\\x0ab\"");
  EXPECT_EQ(unit_word(";"), "\";\"");
  EXPECT_EQ(service_name("shows/evening 2.lua"), "evening-2");
  EXPECT_FALSE(
      service_unit_text({.scene = "s", .name = "limber-s", .program = "/limber", .folder = "/a\nb", .words = {}}));
}

TEST(Service, InstallWritesTheUnitAndPrintsIt) {
  const TempFolder home;
  const TempFolder show;
  show.file("evening show.lua", kServedScene);
  const std::vector<std::string> args = {
      "install", "evening show.lua", "--headless", "--set", "/scene/text=$HOME 50% x", "--name", "evening"};
  const RunResult result = run_service(home, args, show.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string unit = content(unit_path(home, "evening"));
  EXPECT_EQ(result.out, unit);
  EXPECT_NE(result.err.find("systemctl --user daemon-reload && systemctl --user enable --now limber-evening"),
            std::string::npos)
      << result.err;
  EXPECT_NE(unit.find(" play \"evening show.lua\" --headless --set \"/scene/text=$$HOME 50%% x\" --osc-optional\n"),
            std::string::npos)
      << unit;
  EXPECT_NE(unit.find("\nWorkingDirectory=" + show.path() + "\n"), std::string::npos) << unit;
  for (const char* line :
       {"Type=notify", "Restart=on-failure", "RestartSec=2", "WatchdogSec=30", "WantedBy=default.target"})
    EXPECT_NE(unit.find(std::string("\n") + line + "\n"), std::string::npos) << line;
  const RunResult window = run_service(home, {"install", "evening show.lua", "--print"}, show.path());
  EXPECT_NE(window.out.find("WantedBy=graphical-session.target"), std::string::npos) << window.out;
  EXPECT_FALSE(fs::exists(unit_path(home, "evening-show"))) << "only printed";
}

TEST(Service, SystemdAcceptsTheUnit) {
  if (Process({"sh", "-c", "command -v systemd-analyze"}).finish().code != 0) GTEST_SKIP() << "no systemd here";
  const TempFolder home;
  const TempFolder show;
  show.file("s.lua", kServedScene);
  ASSERT_EQ(run_service(home, {"install", "s.lua", "--set", "/a=\"q\\ %h;"}, show.path()).code, 0);
  const RunResult result =
      Process({"env", "XDG_RUNTIME_DIR=" + home.path(), "systemd-analyze", "verify", "--user", unit_path(home, "s")})
          .finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("limber-s.service"), std::string::npos) << result.err;
}

TEST(Service, ReplacesAndRemovesOnlyItsOwnUnits) {
  const TempFolder home;
  const TempFolder show;
  show.file("s.lua", kServedScene);
  const std::string foreign = "[Service]\nExecStart=/bin/true\n";
  home.file("systemd/user/limber-s.service", foreign);
  const RunResult rejected = run_service(home, {"install", "s.lua"}, show.path());
  EXPECT_EQ(rejected.code, 1);
  EXPECT_NE(rejected.err.find("limber-s.service was not written by `limber service install`"), std::string::npos)
      << rejected.err;
  EXPECT_EQ(run_service(home, {"remove", "s"}, show.path()).code, 1);
  EXPECT_EQ(content(unit_path(home, "s")), foreign);
  const std::string elsewhere = home.file("elsewhere", std::string(kServiceHeader) + "\n");
  fs::create_symlink(elsewhere, unit_path(home, "link"));
  EXPECT_EQ(run_service(home, {"install", "s.lua", "--name", "link"}, show.path()).code, 1) << "a link is not ours";

  ASSERT_EQ(run_service(home, {"install", "s.lua", "--name=mine"}, show.path()).code, 0);
  ASSERT_EQ(run_service(home, {"install", "s.lua", "--name=mine", "--quiet"}, show.path()).code, 0);
  EXPECT_NE(content(unit_path(home, "mine")).find("--quiet"), std::string::npos) << "replaced";
  fs::create_directories(home.path() + "/systemd/user/default.target.wants");
  const std::string enabled = home.path() + "/systemd/user/default.target.wants/limber-mine.service";
  fs::create_symlink(unit_path(home, "mine"), enabled);
  EXPECT_EQ(run_service(home, {"remove"}, show.path()).code, 0) << "the only one";
  EXPECT_FALSE(fs::exists(unit_path(home, "mine")));
  EXPECT_FALSE(fs::is_symlink(enabled));
  EXPECT_EQ(run_service(home, {"remove"}, show.path()).code, 1);
  EXPECT_EQ(content(unit_path(home, "s")), foreign);
}

TEST(Service, InstallChecksItsOptions) {
  const TempFolder home;
  const TempFolder show;
  show.file("s.lua", kServedScene);
  EXPECT_EQ(run_service(home, {"install", "nowhere.lua"}, show.path()).code, 1);
  const RunResult mistyped = run_service(home, {"install", "s.lua", "--fulscreen"}, show.path());
  EXPECT_EQ(mistyped.code, 2);
  EXPECT_NE(mistyped.err.find("did you mean '--fullscreen'"), std::string::npos) << mistyped.err;
  EXPECT_EQ(run_service(home, {"install", "s.lua", "--fast"}, show.path()).code, 2);
  EXPECT_EQ(run_service(home, {"install", "s.lua", "--name", "../s"}, show.path()).code, 2);
  EXPECT_EQ(run_service(home, {"install", "--help"}, show.path()).code, 0);
  EXPECT_FALSE(fs::exists(home.path() + "/systemd"));
}

TEST(Service, ErrorsNameTheFix) {
  const TempFolder home;
  const TempFolder show;
  show.file("s.lua", kServedScene);
  const auto error = [&](std::vector<std::string> args, int code, const std::string& folder) {
    const RunResult result = run_service(home, std::move(args), folder);
    EXPECT_EQ(result.code, code) << result.err;
    return result.err;
  };
  const auto expect = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(error({"remove"}, 1, show.path()), "no service is installed in " + home.path() + "/systemd/user");
  ASSERT_EQ(run_service(home, {"install", "s.lua", "--name", "a"}, show.path()).code, 0);
  ASSERT_EQ(run_service(home, {"install", "s.lua", "--name", "b"}, show.path()).code, 0);
  expect(error({"remove"}, 1, show.path()), "several services are installed: a, b. Write limber service remove NAME");
  expect(error({"remove", "c"}, 1, show.path()), "limber-c.service not found; installed: a, b");
  expect(error({"remove", "../c"}, 2, show.path()),
         "'../c' is not a valid service name: use only letters, digits, _ and -");
  expect(error({"install", "s.lua", "--render", "f.mp4", "--duration", "1"}, 2, show.path()),
         "--render and --screenshot are for batch runs; a service plays in real time");
  show.file("blank /s.lua", kServedScene);
  expect(error({"install", "s.lua"}, 1, show.path() + "/blank "),
         "ends with a space or a backslash. Start the show from another folder");
  const RunResult homeless =
      Process(limber_command({"service", "install"}, {"env", "-u", "HOME", "-u", "XDG_CONFIG_HOME"})).finish();
  EXPECT_EQ(homeless.code, 3);
  expect(homeless.err, "HOME is not set: there is no folder for units");
  fs::create_directories(home.path() + "/file");
  home.file("file/systemd", "");
  const RunResult unwritable =
      Process(limber_command({"service", "install"}, {"env", "XDG_CONFIG_HOME=" + home.path() + "/file"})).finish();
  EXPECT_EQ(unwritable.code, 3);
  expect(unwritable.err, "limber-arms.service can't be written: ");
}

// the service manager's side of the socket
class Manager {
 public:
  explicit Manager(bool abstract) : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    name_ = abstract ? fmt::format("@limber_test_{}", ::getpid()) : folder_.path() + "/notify";
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name_.data(), name_.size());
    if (abstract) address.sun_path[0] = '\0';
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), length), 0);
  }
  ~Manager() { close(socket_); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  const std::string& name() const { return name_; }
  /// Returns the next message.
  std::string next() {
    pollfd polled{socket_, POLLIN, 0};
    if (poll(&polled, 1, kTimeoutMs) != 1) {
      ADD_FAILURE() << "no message for two minutes";
      return "";
    }
    char buffer[4096];
    const ssize_t n = recv(socket_, buffer, sizeof buffer, 0);
    return {buffer, static_cast<std::size_t>(std::max<ssize_t>(n, 0))};
  }
  /// Returns the messages up to the first one that contains this line.
  std::vector<std::string> until(const std::string& line) {
    std::vector<std::string> all;
    do {
      all.push_back(next());
    } while (!all.back().empty() && ("\n" + all.back() + "\n").find("\n" + line) == std::string::npos);
    return all;
  }
  void forget() {
    char buffer[4096];
    while (recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT) > 0) {
    }
  }

 private:
  TempFolder folder_;
  int socket_;
  std::string name_;
};

std::vector<std::string> managed(const Manager& manager, const std::string& scene) {
  return limber_command({"play", scene, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off"},
                        {"env", "NOTIFY_SOCKET=" + manager.name(), "WATCHDOG_USEC=80000"});
}

bool has_watchdog(const std::vector<std::string>& messages) {
  return std::ranges::any_of(messages, [](const std::string& m) { return m == "WATCHDOG=1"; });
}

TEST(Service, NotifiesStartWatchdogAndEnd) {
  for (const bool abstract : {false, true}) {
    Manager manager(abstract);
    const TempFolder folder;
    Process running(managed(manager, folder.file("s.lua", "sim:after(0.2, function() sim.paused = true end)\n")));
    const std::vector<std::string> start = manager.until("READY=1");
    ASSERT_EQ(start.back().find("READY=1"), 0U) << start.back();
    EXPECT_FALSE(has_watchdog(start)) << "nothing before";
    manager.until("WATCHDOG=1");
    while (manager.next().find("paused") == std::string::npos) {
    }
    manager.forget();
    for (int i = 0; i < 3; i++) EXPECT_EQ(manager.until("WATCHDOG=1").back(), "WATCHDOG=1") << "paused, too";
    running.signal(SIGTERM);
    manager.until("STOPPING=1");
    EXPECT_EQ(running.finish().code, 0);
  }
}

// returns the id of the thread with this name; 0: none
pid_t thread_of(pid_t process, const std::string& name) {
  for (const fs::directory_entry& entry : fs::directory_iterator(fmt::format("/proc/{}/task", process))) {
    if (content(entry.path() / "comm") == name + "\n") return std::stoi(entry.path().filename().string());
  }
  return 0;
}

// only the simulation's thread is stopped: the main thread still reports its status
TEST(Service, StoppedSimulationDoesNotFeedTheWatchdog) {
  Manager manager(false);
  const TempFolder folder;
  const Process running(managed(manager, folder.file("s.lua", kServedScene)));
  manager.until("WATCHDOG=1");
  const pid_t thread = thread_of(running.pid(), "limber-sim");
  ASSERT_GT(thread, 0);
  if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0) GTEST_SKIP() << "ptrace is not permitted here";
  ASSERT_EQ(ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr), 0);
  ASSERT_EQ(waitpid(thread, nullptr, __WALL), thread);
  manager.forget();
  std::vector<std::string> messages = manager.until("STATUS=");
  for (const std::string& message : manager.until("STATUS=")) messages.push_back(message);
  EXPECT_FALSE(has_watchdog(messages));
  ASSERT_EQ(ptrace(PTRACE_DETACH, thread, nullptr, nullptr), 0);
  EXPECT_EQ(manager.until("WATCHDOG=1").back(), "WATCHDOG=1");
}

TEST(Service, LongLoadExtendsTheStartTimeout) {
  Manager manager(false);
  const TempFolder folder;
  Process running(managed(manager, folder.file("s.lua", "local n = 0\nwhile n < 1e8 do n = n + 1 end\n")));
  const std::vector<std::string> start = manager.until("READY=1");
  EXPECT_EQ(start.front().find("EXTEND_TIMEOUT_USEC=15000000\n"), 0U) << start.front();
}

TEST(Service, JournalGetsLevelsInsteadOfAPrefix) {
  const TempFolder folder;
  const std::string log = folder.file("journal", "");
  const std::string scene = folder.file("s.lua", "sim:after(0.1, function() error('lost') end)\n");
  const std::string command =
      "JOURNAL_STREAM=$(stat -c %d:%i \"$1\") exec \"$2\" \"$3\" --headless --osc-in off --osc-out off --query off "
      "--ticks 30 2>\"$1\"";
  const std::vector<std::string> words = {"sh", "-c", command, "sh", log, LIMBER_PROGRAM, scene};
  EXPECT_EQ(Process(words).finish().code, 0);
  const std::string text = content(log);
  EXPECT_NE(text.find("<6>playing headless"), std::string::npos) << text;
  EXPECT_NE(text.find("<3>error: "), std::string::npos) << text;
  EXPECT_EQ(text.find("limber: "), std::string::npos) << text;
  EXPECT_EQ(text.find("real time"), std::string::npos) << "the status is for a terminal: " << text;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) EXPECT_EQ(text[at], '<') << text.substr(at);
}

}  // namespace
}  // namespace limber::app::test
