// A private X display with simulated input and readable pixels.
#pragma once

#include <memory>

#include "app/program.h"
#include "base/system/process.h"

namespace limber::app::test {

/// An X server without a screen.
class Display {
 public:
  /// `more`: further arguments of the server. The display number is the lowest free one, or `number`, such as ":1234".
  explicit Display(const std::string& screen = "320x240x24", const std::vector<std::string>& more = {},
                   const std::string& number = "")
      : words_(with({"-displayfd", "1", "-screen", "0", screen, "-nolisten", "tcp", "-fbdir", folder_.path()}, more)),
        server_(std::make_unique<Process>(with(
            number.empty() ? std::vector<std::string>{"Xvfb"} : std::vector<std::string>{"Xvfb", number}, words_))) {
    EXPECT_TRUE(server_->wait_for("\n", true)) << "apt-get install xvfb\n" << server_->err();
    name_ = ":" + server_->out().substr(0, server_->out().find('\n'));
  }
  /// A high display number that depends on the process.
  static std::string own_number() { return ":" + std::to_string(1000 + system::process_id() % 50000); }
  void kill() { server_->signal(SIGKILL); }
  /// Starts another server with the same number after the last one was stopped. Needs a number that no other test takes
  /// meanwhile: own_number().
  void restart() {
    server_.reset();
    server_ = std::make_unique<Process>(with({"Xvfb", name_}, words_));
    EXPECT_TRUE(server_->wait_for("\n", true)) << server_->err();
  }
  std::vector<std::string> environment() const {
    std::vector<std::string> all = without_leak_check();
    all.insert(all.end(),
               {"DISPLAY=" + name_, "LIBGL_ALWAYS_SOFTWARE=1", "XDG_CONFIG_HOME=" + (folder_.path() + "/config"),
                "XDG_STATE_HOME=" + (folder_.path() + "/state")});
    return all;
  }
  /// Simulates input with xdotool. Keys go to the window under the pointer.
  void xdotool(std::vector<std::string> words) const {
    words.insert(words.begin(), "xdotool");
    std::vector<std::string> all = environment();
    all.insert(all.end(), words.begin(), words.end());
    const RunResult result = Process(all).finish();
    EXPECT_EQ(result.code, 0) << "apt-get install xdotool\n" << result.err;
  }
  /// Returns the color of a pixel of the screen, 0xrrggbb, from the server's frame buffer file (XWD: 25 numbers,
  /// colors, rows).
  unsigned pixel(std::size_t x, std::size_t y) const {
    const std::string screen = content(folder_.path() + "/Xvfb_screen0");
    const auto number = [&](std::size_t i) {
      unsigned value = 0;
      for (std::size_t k = 0; k < 4; k++) value = value << 8 | static_cast<unsigned char>(screen[4 * i + k]);
      return value;
    };
    if (screen.size() < 100) return 0;
    const std::size_t at = number(0) + std::size_t{12} * number(19) + y * number(12) + 4 * x;
    if (at + 4 > screen.size()) return 0;
    unsigned color = 0;
    for (std::size_t k = 3; k-- > 0;) color = color << 8 | static_cast<unsigned char>(screen[at + k]);
    return color;
  }
  std::string settings() const { return content(folder_.path() + "/config/limber/panel.json"); }

 private:
  static std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  TempFolder folder_;
  std::vector<std::string> words_;
  std::unique_ptr<Process> server_;
  std::string name_;
};

/// Arguments for a small window without network.
inline std::vector<std::string> quiet(const std::string& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> args = {scene, "--osc-in", "off", "--osc-out", "off", "--query", "off", "--size", "64x36"};
  args.insert(args.end(), more.begin(), more.end());
  return args;
}

}  // namespace limber::app::test
