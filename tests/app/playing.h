// A scene that plays in real time, with a runtime folder of its own, for tests of what talks to it.
#pragma once

#include <string>
#include <vector>

#include "app/program.h"
#include "console/private_folder.h"

namespace limber::app_test {

class Playing {
 public:
  explicit Playing(const std::string& scene)
      : file_(folder_.file("scripts/scene.lua", scene)), running_(words({"play", file_})) {
    EXPECT_TRUE(running_.wait_for("playing headless")) << running_.err();
  }

  /// Another program beside it, in the same runtime folder.
  std::vector<std::string> words(std::vector<std::string> args) const {
    if (!args.empty() && args[0] == "play")
      args.insert(args.end(), {"--osc-in", "off", "--osc-out", "off", "--query", "off"});
    return limber(std::move(args), environment());
  }
  std::vector<std::string> environment() const {
    return {"env",
            "XDG_RUNTIME_DIR=" + runtime_.path(),
            "TMPDIR=" + runtime_.path(),
            "XDG_STATE_HOME=" + (runtime_ / "state"),
            "TERM=xterm",
            "LC_ALL=C.UTF-8"};
  }
  Ran console(std::vector<std::string> args) const {
    args.insert(args.begin(), "console");
    return Running(words(std::move(args))).finish();
  }
  /// The console with these lines on its stdin.
  Ran pipe(const std::string& lines) const {
    std::vector<std::string> all = environment();
    all.insert(all.end(), {"sh", "-c", "printf %s \"$1\" | \"$0\" console", LIMBER_PROGRAM, lines});
    return Running(all).finish();
  }
  const std::string& file() const { return file_; }
  const PrivateFolder& runtime() const { return runtime_; }
  Running& running() { return running_; }
  /// Its process, as the name of its socket tells.
  std::string pid() const {
    const std::string& said = running_.err();
    const std::size_t at = said.find("/limber-", said.find("limber: console ")) + 8;
    return said.substr(at, said.find(".sock", at) - at);
  }

 private:
  Folder folder_;
  PrivateFolder runtime_;
  std::string file_;
  Running running_;
};

}  // namespace limber::app_test
