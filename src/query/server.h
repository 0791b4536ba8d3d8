// QueryServer: OSCQuery and the remote panel, HTTP and WebSocket on one TCP port, on a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/osc_plan.h"
#include "base/result.h"
#include "base/system/wake.h"
#include "engine/link.h"
#include "query/doors.h"

namespace limber {

class QueryServer {
 public:
  /// Make it before the engine starts (it sets `link.wake_query`, which stays usable when the server is gone). `link`
  /// outlives it.
  QueryServer(EngineLink& link, QueryDoors doors);
  ~QueryServer();
  QueryServer(const QueryServer&) = delete;
  QueryServer& operator=(const QueryServer&) = delete;

  /// Opens the port (0: the system chooses) and starts the thread. The error names the address and the options that
  /// change it. [main]
  Result<void> start(const ListenAddress& at);
  /// Ends the thread at once and closes everything. Idempotent. [main]
  void stop();

  /// The port as bound; 0: not open. [main]
  std::uint16_t port() const;

 private:
  struct Running;
  EngineLink& link_;
  QueryDoors doors_;
  std::unique_ptr<Running> running_;
  std::shared_ptr<system::Wake> wake_;
};

}  // namespace limber
