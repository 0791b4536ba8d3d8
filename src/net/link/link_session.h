// LinkSession: takes part in an Ableton Link session by the program limber-link, which it starts: the clock of the show
// follows the beat of the session, and the session follows the tempo that the performer sets.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/system/child_process.h"
#include "base/system/wake.h"
#include "engine/output/engine_link.h"
#include "net/link/link_line.h"

namespace limber::link {

/// Translates between the lines of limber-link and the messages of the show. [the session's thread]
class LinkTranslator {
 public:
  /// Returns the messages to the show for a line of limber-link. `clock`: the show's.
  std::vector<Message> messages(const LinkLine& line, const sim::ClockReading& clock);
  /// Returns the lines that tell limber-link which tempo, bar or start and stop the performer has set since the last
  /// call. `clock`: the show's, at this tick.
  std::string lines(const sim::ClockReading& clock, std::uint64_t tick);

 private:
  std::optional<bool> playing_;  // of the session, when the last line came
  std::uint64_t tick_ = 0;
  std::optional<sim::ClockReading> last_;  // the show's clock in the last call
};

class LinkSession {
 public:
  /// `link` must outlive the session. `program`: limber-link.
  LinkSession(engine::EngineLink& link, std::string program) : link_(link), program_(std::move(program)) {}
  ~LinkSession() { stop(); }
  LinkSession(const LinkSession&) = delete;
  LinkSession& operator=(const LinkSession&) = delete;

  /// Starts the thread. A program that can't be started, or that ends, is reported, and started again. [main]
  void start();
  /// Leaves the session and stops the thread. Idempotent. [main]
  void stop();

 private:
  void run();
  /// Starts limber-link if it doesn't run and it is time to. Returns the time to wait for its next line, ns.
  std::int64_t update_program(std::int64_t now);
  void read_lines(std::int64_t now);
  void handle(std::string_view line);
  void end_program(const char* reason, std::int64_t now);

  engine::EngineLink& link_;
  const std::string program_;
  system::Wake wake_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  // used by the thread only
  system::ChildProcess process_;
  LinkTranslator translator_;
  std::string received_;       // the beginning of a line
  std::int64_t retry_at_ = 0;  // ns
  std::int64_t heard_at_ = 0;  // ns; when the last line came
  std::uint32_t peers_ = 0;
  bool reported_ = false;  // that it doesn't run
};

}  // namespace limber::link
