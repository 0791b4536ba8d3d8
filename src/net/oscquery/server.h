// QueryServer: OSCQuery and the remote panel over HTTP and WebSocket on one TCP port, on its own thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/osc_config.h"
#include "base/result.h"
#include "base/system/wake.h"
#include "engine/output/engine_link.h"
#include "net/oscquery/host.h"

namespace limber::oscquery {

/// The HTTP and WebSocket server.
class QueryServer {
 public:
  /// Create it before the engine starts: the constructor sets `link.wake_query`, which stays callable after the server
  /// is destroyed. `link` must outlive the server.
  QueryServer(engine::EngineLink& link, QueryHost host);
  ~QueryServer();
  QueryServer(const QueryServer&) = delete;
  QueryServer& operator=(const QueryServer&) = delete;

  /// Opens the port (0: the system chooses) and starts the thread. The error names the address and the options that
  /// change it. [main]
  Result<void> start(const ListenAddress& at);
  /// Stops the thread immediately and closes all connections. Idempotent. [main]
  void stop();

  /// The bound port; 0 if it is not open. [main]
  std::uint16_t port() const;

 private:
  struct Running;
  engine::EngineLink& link_;
  QueryHost host_;
  std::unique_ptr<Running> running_;
  std::shared_ptr<system::Wake> wake_;
};

}  // namespace limber::oscquery
