// `limber console` at a terminal: prompt, completion, history, several lines, what the show says meanwhile.
#include <pty.h>

#include "app/playing.h"

namespace limber::app_test {
namespace {

/// A console that believes that somebody sits there.
class Typist {
 public:
  explicit Typist(const Playing& show) {
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
  ~Typist() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(fd_);
  }
  Typist(const Typist&) = delete;
  Typist& operator=(const Typist&) = delete;

  void type(const std::string& keys) const {
    EXPECT_EQ(write(fd_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Reads until this has come; gives what came up to its end.
  std::string until(const std::string& text) {
    while (true) {
      const std::size_t at = in_.find(text);
      if (at != std::string::npos) {
        std::string came = in_.substr(0, at + text.size());
        in_.erase(0, came.size());
        return came;
      }
      if (!read_some()) {
        ADD_FAILURE() << "'" << text << "' never came, but:\n" << in_;
        return in_;
      }
    }
  }
  /// Reads until the prompt has come and the editor has the terminal, which it takes right after: what is typed before
  /// is echoed twice, and Ctrl+C would drop it. Gives what came.
  std::string prompted(const std::string& prompt = "limber> ") {
    std::string came = until(prompt);
    termios mode{};
    for (int left = kPatienceMs; left > 0 && tcgetattr(fd_, &mode) == 0 && (mode.c_lflag & ICANON) != 0; left--) {
      poll(nullptr, 0, 1);
    }
    return came;
  }
  /// Types a line and gives what is between it and the next prompt.
  std::string line(const std::string& text, const std::string& prompt = "limber> ") {
    type(text + "\n");
    until("\r\n");
    std::string came = prompted(prompt);
    came.resize(came.size() - prompt.size());
    return came;
  }
  int finish() {
    while (read_some()) {
    }
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  const std::string& left() const { return in_; }

 private:
  bool read_some() {
    pollfd polled{fd_, POLLIN, 0};
    char bytes[4096];
    if (poll(&polled, 1, kPatienceMs) <= 0) return false;
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

TEST(Terminal, EvaluatesAndKeepsAHistory) {
  Playing show(kTypedScene);
  {
    Typist typist(show);
    EXPECT_NE(typist.prompted().find("plays " + show.file()), std::string::npos);
    EXPECT_EQ(typist.line("apple + 1"), "4\r\n");
    EXPECT_EQ(typist.line("apple = 5"), "");
    EXPECT_TRUE(typist.line("aple").starts_with("console:1: there is no global 'aple'; did you mean 'apple'?\r\n"));
    // up twice: the line before the last
    typist.type("\x1b[A\x1b[A");
    typist.until(" = 5");
    typist.type("0\n");
    typist.prompted();
    EXPECT_EQ(typist.line("apple"), "50\r\n");
    typist.type("\x04");
    EXPECT_EQ(typist.finish(), 0);
  }
  Typist again(show);
  again.prompted();
  again.type("\x1b[A");
  again.until("apple");
  again.type(" + 1\n");
  EXPECT_NE(again.prompted().find("\r\n51\r\n"), std::string::npos);
}

TEST(Terminal, SeveralLinesMakeAChunkAndCtrlCGivesItUp) {
  Playing show(kTypedScene);
  Typist typist(show);
  typist.prompted();
  EXPECT_EQ(typist.line("for i = 1, 2 do", ".. "), "     ");
  EXPECT_EQ(typist.line("print(i)", ".. "), "     ");
  EXPECT_EQ(typist.line("end"), "1\r\n2\r\n");
  EXPECT_EQ(typist.line("if apple then", ".. "), "     ");
  typist.type("\x03");
  typist.until("^C\r\n");
  typist.prompted();
  EXPECT_EQ(typist.line("apple"), "3\r\n");
  // and a line that is only begun
  typist.type("apple = 99");
  typist.until("apple = 99");
  typist.type("\x03");
  typist.prompted();
  EXPECT_EQ(typist.line("apple"), "3\r\n");
}

TEST(Terminal, TabCompletes) {
  Playing show(kTypedScene);
  Typist typist(show);
  typist.prompted();
  typist.type("sim:body(\"a\t");
  typist.until("rm");  // the editor draws what is new
  typist.type("\"):part(1).restit\t");
  typist.until("ution");
  EXPECT_EQ(typist.line(""), "0\r\n");
  // several: as far as they go, then all of them
  typist.type("sim.time\t");
  const std::string offered = typist.prompted();
  EXPECT_NE(offered.find("time      timestep"), std::string::npos) << offered;
  typist.until("sim.time");
  typist.type("s\t");
  typist.until("tep");
  EXPECT_NE(typist.line("").find("0.0166"), std::string::npos);
}

TEST(Terminal, WhatTheShowSaysComesAboveTheLineThatIsTyped) {
  Playing show(kTypedScene);
  Typist typist(show);
  typist.prompted();
  EXPECT_EQ(typist.line("later('hello')"), "");
  typist.type("app");
  typist.until("\r\x1b[Khello\r\n");
  typist.until("limber> app");
  EXPECT_EQ(typist.line("le"), "3\r\n");
}

TEST(Terminal, TheEndOfTheShowIsSaid) {
  Playing show(kTypedScene);
  Typist typist(show);
  typist.prompted();
  show.running().signal(SIGINT);
  typist.until("limber has ended");
  EXPECT_EQ(typist.finish(), 0);
}

TEST(Terminal, AnAnswerThatNeverComesCanBeGivenUp) {
  Playing show(kTypedScene);
  Typist typist(show);
  typist.prompted();
  // a program that does not go on
  show.running().signal(SIGSTOP);
  typist.type("apple\n");
  typist.until("\r\n");
  typist.type("\x03");
  typist.until("its answer is not awaited");
  typist.prompted();
  // it comes late, as anything that the program says
  show.running().signal(SIGCONT);
  typist.until("3\r\n");
  typist.prompted();
  EXPECT_EQ(typist.line("apple + 1"), "4\r\n");
}

}  // namespace
}  // namespace limber::app_test
