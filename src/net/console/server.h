// ConsoleServer: serves consoles over a local socket that only this user can open. A thread of its own turns requests
// into commands for the simulation thread and sends back the results; no simulation step ever waits for it.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "base/system/wake.h"
#include "engine/output/engine_link.h"
#include "net/console/connection.h"

namespace limber::console {

struct ConsoleOptions {
  std::string folder;      ///< Folder of the socket; empty: make_runtime_folder().
  std::string scene;       ///< Scene name, sent to each console in the first line.
  long allowed_user = -1;  ///< User id of the accepted consoles; -1: the user that runs the program.
};

class ConsoleServer {
 public:
  static constexpr std::size_t kMaxConnections = 8;

  /// `link` outlives it.
  ConsoleServer(engine::EngineLink& link, ConsoleOptions options);
  ~ConsoleServer();
  ConsoleServer(const ConsoleServer&) = delete;
  ConsoleServer& operator=(const ConsoleServer&) = delete;

  /// Opens the socket, removes those of programs that have exited, starts the thread. [main]
  Result<void> start();
  /// Stops the thread and removes the socket. Idempotent. [main]
  void stop();
  /// Returns the path of the socket; empty when stopped. [main]
  const std::string& path() const { return path_; }

 private:
  // Results from the simulation thread. Shared, because a pending request may outlive the server.
  struct ResultQueue {
    struct Entry {
      std::uint64_t connection = 0;
      std::uint64_t id = 0;
      Evaluation evaluation;
    };
    BoundedQueue<Entry> results{kMaxConnections};  // at most one pending request per connection
    system::Wake wake;
  };

  void run();
  void wait_for_events();
  void accept_connections();
  void deliver_results();
  std::string submit(std::uint64_t connection, const ConsoleRequest& request);

  engine::EngineLink& link_;
  const ConsoleOptions options_;
  std::string path_;
  system::Descriptor listener_;
  std::shared_ptr<ResultQueue> result_queue_ = std::make_shared<ResultQueue>();
  std::map<std::uint64_t, ConsoleConnection> connections_;
  std::uint64_t last_connection_ = 0;
  bool accept_paused_ = false;  // accept() failed for lack of resources: skip the listener in the next poll
  std::vector<ResultQueue::Entry> results_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace limber::console
