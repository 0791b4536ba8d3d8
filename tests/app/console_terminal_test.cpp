// `limber console` at a terminal: prompt, completion, history, multiple lines, and messages of the show meanwhile.
#include <pty.h>

#include "app/playing.h"

namespace limber::app::test {
namespace {

/// A console on a pseudo terminal.
class ConsoleUser {
 public:
  explicit ConsoleUser(const Playing& show) {
    const std::vector<std::string> words = show.words({"console"});
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    winsize size{24, 100, 0, 0};
    pid_ = forkpty(&fd_, nullptr, nullptr, &size);
    if (pid_ == 0) {
      execvp(argv[0], argv.data());
      _exit(127);
    }
  }
  ~ConsoleUser() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(fd_);
  }
  ConsoleUser(const ConsoleUser&) = delete;
  ConsoleUser& operator=(const ConsoleUser&) = delete;

  void type(const std::string& keys) const {
    EXPECT_EQ(write(fd_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Reads until `text` appears; returns the output up to its end.
  std::string read_until(const std::string& text) {
    while (true) {
      const std::size_t at = in_.find(text);
      if (at != std::string::npos) {
        std::string output = in_.substr(0, at + text.size());
        in_.erase(0, output.size());
        return output;
      }
      if (!read_some()) {
        ADD_FAILURE() << "'" << text << "' not found in:\n" << in_;
        return in_;
      }
    }
  }
  /// Reads until the prompt appears and the editor has switched the terminal to raw mode right after: earlier input is
  /// echoed twice, and Ctrl+C would discard it. Returns the output.
  std::string wait_for_prompt(const std::string& prompt = "limber> ") {
    std::string output = read_until(prompt);
    termios mode{};
    for (int left = kTimeoutMs; left > 0 && tcgetattr(fd_, &mode) == 0 && (mode.c_lflag & ICANON) != 0; left--) {
      poll(nullptr, 0, 1);
    }
    return output;
  }
  /// Types a line and returns the output between it and the next prompt.
  std::string line(const std::string& text, const std::string& prompt = "limber> ") {
    type(text + "\n");
    read_until("\r\n");
    std::string output = wait_for_prompt(prompt);
    output.resize(output.size() - prompt.size());
    return output;
  }
  int finish() {
    while (read_some()) {
    }
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  const std::string& unread() const { return in_; }

 private:
  bool read_some() {
    pollfd polled{fd_, POLLIN, 0};
    char bytes[4096];
    if (poll(&polled, 1, kTimeoutMs) <= 0) return false;
    const ssize_t n = read(fd_, bytes, sizeof bytes);
    if (n <= 0) return false;
    in_.append(bytes, static_cast<std::size_t>(n));
    return true;
  }

  pid_t pid_ = -1;
  int fd_ = -1;
  std::string in_;
};

constexpr const char* kTypedScene = R"(
sim:add_body("arm"):add_part("tip", sim:add_sphere_shape("ball", 1), { mass = 0 })
apple = 3
osc:on("/never", print)
function later(text) sim:after(0.05, function() print(text) end) end
)";

TEST(Terminal, EvaluatesAndSavesHistory) {
  Playing show(kTypedScene);
  {
    ConsoleUser typist(show);
    EXPECT_NE(typist.wait_for_prompt().find("plays " + show.file()), std::string::npos);
    EXPECT_EQ(typist.line("apple + 1"), "4\r\n");
    EXPECT_EQ(typist.line("apple = 5"), "");
    EXPECT_TRUE(typist.line("aple").starts_with("console:1: there is no global 'aple'; did you mean 'apple'?\r\n"));
    // up twice: the line before the last
    typist.type("\x1b[A\x1b[A");
    typist.read_until(" = 5");
    typist.type("0\n");
    typist.wait_for_prompt();
    EXPECT_EQ(typist.line("apple"), "50\r\n");
    typist.type("\x04");
    EXPECT_EQ(typist.finish(), 0);
  }
  ConsoleUser again(show);
  again.wait_for_prompt();
  again.type("\x1b[A");
  again.read_until("apple");
  again.type(" + 1\n");
  EXPECT_NE(again.wait_for_prompt().find("\r\n51\r\n"), std::string::npos);
}

TEST(Terminal, JoinsIncompleteLinesAndCtrlCCancels) {
  Playing show(kTypedScene);
  ConsoleUser typist(show);
  typist.wait_for_prompt();
  EXPECT_EQ(typist.line("for i = 1, 2 do", ".. "), "     ");
  EXPECT_EQ(typist.line("print(i)", ".. "), "     ");
  EXPECT_EQ(typist.line("end"), "1\r\n2\r\n");
  EXPECT_EQ(typist.line("if apple then", ".. "), "     ");
  typist.type("\x03");
  typist.read_until("^C\r\n");
  typist.wait_for_prompt();
  EXPECT_EQ(typist.line("apple"), "3\r\n");
  // also for an incomplete line
  typist.type("apple = 99");
  typist.read_until("apple = 99");
  typist.type("\x03");
  typist.wait_for_prompt();
  EXPECT_EQ(typist.line("apple"), "3\r\n");
}

TEST(Terminal, TabCompletes) {
  Playing show(kTypedScene);
  ConsoleUser typist(show);
  typist.wait_for_prompt();
  typist.type("sim:body(\"a\t");
  typist.read_until("rm");  // the editor draws only the new characters
  typist.type("\"):part(1).restit\t");
  typist.read_until("ution");
  EXPECT_EQ(typist.line(""), "0\r\n");
  // several candidates: their common prefix, then all of them
  typist.type("sim.time\t");
  const std::string offered = typist.wait_for_prompt();
  EXPECT_NE(offered.find("time      timestep"), std::string::npos) << offered;
  typist.read_until("sim.time");
  typist.type("s\t");
  typist.read_until("tep");
  EXPECT_NE(typist.line("").find("0.0166"), std::string::npos);
}

TEST(Terminal, ShowsMessagesAboveTheEditedLine) {
  Playing show(kTypedScene);
  ConsoleUser typist(show);
  typist.wait_for_prompt();
  EXPECT_EQ(typist.line("later('hello')"), "");
  typist.type("app");
  typist.read_until("\r\x1b[Khello\r\n");
  typist.read_until("limber> app");
  EXPECT_EQ(typist.line("le"), "3\r\n");
}

TEST(Terminal, ReportsTheEndOfTheShow) {
  Playing show(kTypedScene);
  ConsoleUser typist(show);
  typist.wait_for_prompt();
  show.running().signal(SIGINT);
  typist.read_until("limber has ended");
  EXPECT_EQ(typist.finish(), 0);
}

TEST(Terminal, CtrlCCancelsTheWaitForAnAnswer) {
  Playing show(kTypedScene);
  ConsoleUser typist(show);
  typist.wait_for_prompt();
  // a stopped program
  show.running().signal(SIGSTOP);
  typist.type("apple\n");
  typist.read_until("\r\n");
  typist.type("\x03");
  typist.read_until("the evaluation may still be running");
  typist.wait_for_prompt();
  // the answer arrives late and is printed like other messages
  show.running().signal(SIGCONT);
  typist.read_until("3\r\n");
  typist.wait_for_prompt();
  EXPECT_EQ(typist.line("apple + 1"), "4\r\n");
}

}  // namespace
}  // namespace limber::app::test
