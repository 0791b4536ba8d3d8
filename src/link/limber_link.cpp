// limber-link: joins an Ableton Link session for Limber, which starts it with --link and talks to it by standard input
// and output. A program of its own because of its license.
//
// SPDX-License-Identifier: GPL-2.0-or-later
// This file is licensed under the GNU General Public License, version 2 or later (COPYING), like the library
// that it includes; the rest of Limber has the license of the file LICENSE.
//
// It prints a line 20 times per second and after each change, "BEAT TEMPO PLAYING PEERS TIME": beats, beats per minute,
// 0 or 1, the number of other programs in the session, and the time of this beat in seconds by the steady clock. It
// reads lines: "tempo TEMPO", "playing 0|1", "bar BEATS".
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include <poll.h>
#include <unistd.h>
#include <ableton/Link.hpp>

namespace {

constexpr int kInterval = 50;  // ms

class Session {
 public:
  Session(double tempo, double bar) : link_(tempo), bar_(bar) {
    link_.enableStartStopSync(true);
    link_.enable(true);
  }

  void execute(std::string_view line) {
    const std::size_t blank = line.find(' ');
    if (blank == std::string_view::npos) return;
    const std::string_view word = line.substr(0, blank);
    const double value = std::strtod(std::string(line.substr(blank + 1)).c_str(), nullptr);
    auto state = link_.captureAppSessionState();
    const auto now = link_.clock().micros();
    if (word == "tempo" && value > 0) state.setTempo(value, now);
    if (word == "playing") state.setIsPlaying(value != 0, now);
    if (word == "bar" && value > 0) bar_ = value;
    link_.commitAppSessionState(state);
  }

  void print() const {
    const auto state = link_.captureAppSessionState();
    const auto now = link_.clock().micros();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now().time_since_epoch();
    std::printf("%.9f %.6f %d %zu %.6f\n", state.beatAtTime(now, bar_), state.tempo(), state.isPlaying() ? 1 : 0,
                link_.numPeers(), time.count());
    std::fflush(stdout);
  }

 private:
  ableton::Link link_;
  double bar_;  // beats
};

// Executes the complete lines in `text` and removes them.
void execute_lines(Session& session, std::string& text) {
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    session.execute(std::string_view(text).substr(0, end));
    text.erase(0, end + 1);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("limber-link is started by `limber play --link`\nusage: limber-link TEMPO BEATS_PER_BAR\n", stderr);
    return 2;
  }
  Session session(std::strtod(argv[1], nullptr), std::strtod(argv[2], nullptr));
  std::string input;
  while (std::ferror(stdout) == 0) {
    session.print();
    pollfd entry{STDIN_FILENO, POLLIN, 0};
    if (poll(&entry, 1, kInterval) <= 0) continue;
    char bytes[4096];
    const ssize_t count = read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) return 0;  // Limber has ended
    input.append(bytes, static_cast<std::size_t>(count));
    if (input.size() > sizeof bytes) return 1;
    execute_lines(session, input);
  }
  return 0;
}
