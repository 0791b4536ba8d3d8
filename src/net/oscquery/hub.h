// QueryHub: holds requests until a value snapshot is available, and distributes changes to clients. It uses the
// engine's link and does no I/O. [query]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/system/clock.h"
#include "engine/output/engine_link.h"
#include "net/oscquery/client.h"
#include "net/oscquery/request.h"

namespace limber::oscquery {

/// The part of the query server between the engine and its connections.
class QueryHub {
 public:
  static constexpr double kUpdateInterval = 1.0 / 30;  ///< s; update interval while a client listens to paths.
  static constexpr double kIdleInterval = 0.2;         ///< s; interval of path events to the other clients.
  static constexpr double kRequestTimeout = 1;         ///< s; how long a request waits for a value snapshot.
  static constexpr std::size_t kMaxRequests = 256;
  /// Approximate limit of all responses from one snapshot.
  static constexpr std::size_t kMaxResponseBytes = std::size_t{64} << 20;

  using Respond = std::function<void(HttpResponse answer)>;

  /// `now` returns a time in seconds. `link` must outlive the hub.
  QueryHub(engine::EngineLink& link, QueryHost host, std::vector<std::string> names,
           double (*now)() = &system::clock_seconds);

  const QueryHost& host() const { return host_; }
  HostInfo info() const;
  /// Calls `respond` immediately, or later from on_link_event() or update().
  void handle_request(HttpRequest request, Respond respond);

  void add_client(QueryClient& client);
  void remove_client(const QueryClient& client);
  /// Requests a value snapshot soon, because a client waits for its first values.
  void request_values();

  /// Handles snapshots and replies that may have arrived by the link.
  void on_link_event();
  /// Updates clients and expires requests. Call it every kUpdateInterval while busy().
  void update();
  /// Discards all pending requests without a response and thereby releases their connections.
  void cancel_all() { waiting_requests_.clear(); }
  /// True if there are pending requests or connected clients.
  bool busy() const { return !waiting_requests_.empty() || !clients_.empty(); }

 private:
  struct WaitingRequest {
    HttpRequest request;
    Respond respond;
    std::uint64_t snapshot_request = 0;
    double since = 0;
  };

  void update_clients(const std::shared_ptr<const engine::ValueSnapshot>& snapshot);
  void respond_waiting(const std::shared_ptr<const engine::ValueSnapshot>& snapshot);
  void send_replies();

  engine::EngineLink& link_;
  const QueryHost host_;
  const std::vector<std::string> names_;
  double (*now_)();
  std::vector<WaitingRequest> waiting_requests_;
  std::vector<QueryClient*> clients_;
  std::shared_ptr<const engine::ValueSnapshot> snapshot_;  // the last one sent to the clients
  std::uint64_t clients_snapshot_request_ = 0;             // request number for the clients; 0: none is pending
  bool request_again_ = false;                             // request another one after it
  double last_request_ = 0;                                // time of the last request for the clients, s
  std::vector<engine::Outgoing> replies_;
};

}  // namespace limber::oscquery
