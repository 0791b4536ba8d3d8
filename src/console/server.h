// ConsoleServer: lets consoles into the running scene by a socket that only this user can open. A thread of its own
// makes commands and hands out answers; whatever comes in, no tick waits for it.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "base/system/wake.h"
#include "console/visitor.h"
#include "engine/link.h"

namespace limber {

struct ConsoleOptions {
  std::string folder;  ///< Where the socket lies; empty: make_runtime_folder().
  std::string scene;   ///< What those who connect are told is played.
  long user = -1;      ///< Whose consoles are let in; -1: the user that the program runs as.
};

class ConsoleServer {
 public:
  static constexpr std::size_t kMostVisitors = 8;

  /// `link` outlives it.
  ConsoleServer(EngineLink& link, ConsoleOptions options);
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;

  /// Opens the socket, removes those of dead programs, starts the thread. The error says what can't be had. [main]
  Result<void> start();
  /// Ends the thread and removes the socket. Idempotent. [main]
  void stop();
  /// Where the socket is; empty when there is none. [main]
  const std::string& path() const { return path_; }

 private:
  // how answers come from the simulation's thread; it outlives the server when one is still under way
  struct Mail {
    struct Answer {
      std::uint64_t visitor = 0;
      std::uint64_t id = 0;
      Evaluation said;
    };
    Inbox<Answer> answers{kMostVisitors};  // each waits for one at most
    system::Wake wake;
  };

  void run();
  void wait_for_something();
  void let_in();
  void hand_out_answers();
  std::string ask(std::uint64_t visitor, const ConsoleRequest& request);

  EngineLink& link_;
  const ConsoleOptions options_;
  std::string path_;
  system::Descriptor listener_;
  std::shared_ptr<Mail> mail_ = std::make_shared<Mail>();
  std::map<std::uint64_t, Visitor> visitors_;
  std::uint64_t last_visitor_ = 0;
  bool rests_ = false;  // no more connections can be had just now
  std::vector<Mail::Answer> answers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace limber
