// SiteServer: serves the files of a folder to browsers on this machine, on its own thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/result.h"

namespace limber::oscquery {

/// The HTTP server of the documentation. It has the limits of the query server (QueryLimits).
class SiteServer {
 public:
  SiteServer();
  ~SiteServer();
  SiteServer(const SiteServer&) = delete;
  SiteServer& operator=(const SiteServer&) = delete;

  /// Listens on 127.0.0.1 at the port (0: the system chooses) and starts the thread. Errors: the folder does not exist,
  /// the port can't be opened. [main]
  Result<void> start(const std::string& folder, std::uint16_t port);
  /// Stops the thread and closes all connections. Idempotent. [main]
  void stop();

  /// The bound port; 0 if it is not open. [main]
  std::uint16_t port() const;

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace limber::oscquery
