// A scene that plays in real time with its own runtime folder, for tests of other programs that talk to it.
#pragma once

#include <string>
#include <vector>

#include "app/program.h"
#include "console/private_folder.h"

namespace limber::app::test {

class Playing {
 public:
  explicit Playing(const std::string& scene)
      : file_(folder_.file("scripts/scene.lua", scene)), running_(words({"play", file_})) {
    EXPECT_TRUE(running_.wait_for("playing headless")) << running_.err();
  }

  /// Returns the command line of another program in the same runtime folder.
  std::vector<std::string> words(std::vector<std::string> args) const {
    if (!args.empty() && args[0] == "play")
      args.insert(args.end(), {"--osc-in", "off", "--osc-out", "off", "--query", "off"});
    return limber_command(std::move(args), environment());
  }
  std::vector<std::string> environment() const {
    return {"env",
            "XDG_RUNTIME_DIR=" + runtime_.path(),
            "TMPDIR=" + runtime_.path(),
            "XDG_STATE_HOME=" + (runtime_ / "state"),
            "TERM=xterm",
            "LC_ALL=C.UTF-8"};
  }
  RunResult console(std::vector<std::string> args) const {
    args.insert(args.begin(), "console");
    return Process(words(std::move(args))).finish();
  }
  /// Runs the console with these lines on stdin.
  RunResult pipe(const std::string& lines) const {
    std::vector<std::string> all = environment();
    all.insert(all.end(), {"sh", "-c", "printf %s \"$1\" | \"$0\" console", LIMBER_PROGRAM, lines});
    return Process(all).finish();
  }
  const std::string& file() const { return file_; }
  const console::PrivateFolder& runtime() const { return runtime_; }
  Process& running() { return running_; }
  /// Process id, from the name of the socket.
  std::string pid() const {
    const std::string& stderr_text = running_.err();
    const std::size_t at = stderr_text.find("/limber-", stderr_text.find("limber: console ")) + 8;
    return stderr_text.substr(at, stderr_text.find(".sock", at) - at);
  }

 private:
  TempFolder folder_;
  console::PrivateFolder runtime_;
  std::string file_;
  Process running_;
};

}  // namespace limber::app::test
