// A connection: a sequence of HTTP requests or, after an upgrade, a WebSocket. Boost.Beast parses the input; this file
// sets the limits on sizes, counts and times. [query]
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include <boost/asio/ip/tcp.hpp>

#include "net/oscquery/hub.h"

namespace limber::oscquery {

/// Limits per client and for the whole server.
struct QueryLimits {
  static constexpr int kConnections = 256;
  static constexpr int kConnectionsPerAddress = 64;             ///< So that one client can't use up all connections.
  static constexpr std::uint32_t kHeader = 8192;                ///< Bytes of a request's header.
  static constexpr std::size_t kFrame = std::size_t{64} << 10;  ///< Bytes of an incoming WebSocket message.
  /// Bytes queued for a client; the connection is closed if there are more.
  static constexpr std::size_t kQueue = std::size_t{1} << 20;
  static constexpr std::size_t kResponses = std::size_t{256} << 20;  ///< Bytes of all responses being sent.
  static constexpr int kSendBuffer = 64 << 10;                       ///< Send buffer of a WebSocket's socket, bytes.
  static constexpr int kReadSeconds = 10;                            ///< Timeout for receiving a request.
  static constexpr int kWriteSeconds = 5;                            ///< Timeout for a client that receives nothing.
  static constexpr int kIdleSeconds = 60;                            ///< Timeout for an idle WebSocket.
};

struct QueryContext;

/// State shared by all connections of a server, and the server's side of them. [query]
struct ConnectionContext {
  virtual ~ConnectionContext() = default;
  /// True if this address (0.0.0.0: unknown) may connect.
  virtual bool is_allowed(const system::IpAddress& address) const = 0;
  /// Calls `respond` immediately or later.
  virtual void handle_request(HttpRequest request, QueryHub::Respond respond) = 0;
  /// Returns the context of WebSockets; null: requests to upgrade are answered like others.
  virtual QueryContext* web_sockets() { return nullptr; }

  int connections = 0;
  std::map<system::IpAddress, int> connections_by_address = {};  ///< 0.0.0.0: unknown.
  int rejected = 0;                ///< Number of rejected connections that are still receiving the reason.
  std::size_t response_bytes = 0;  ///< Bytes of responses being sent.

  /// True if a further connection from this address must be rejected.
  bool full(const system::IpAddress& address) const {
    const auto used = connections_by_address.find(address);
    return connections >= QueryLimits::kConnections ||
           (used != connections_by_address.end() && used->second >= QueryLimits::kConnectionsPerAddress);
  }
};

/// The connections of the query server.
struct QueryContext : ConnectionContext {
  explicit QueryContext(QueryHub& hub_of_server) : hub(hub_of_server) {}
  bool is_allowed(const system::IpAddress& address) const override { return hub.host().is_allowed(address); }
  void handle_request(HttpRequest request, QueryHub::Respond respond) override {
    hub.handle_request(std::move(request), std::move(respond));
  }
  QueryContext* web_sockets() override { return this; }

  QueryHub& hub;
};

/// Counts an open connection during its lifetime.
class ConnectionSlot {
 public:
  /// `accepted`: true for an accepted connection, false for a rejected one.
  ConnectionSlot(ConnectionContext& context, const system::IpAddress& address, bool accepted)
      : context_(&context), address_(address), accepted_(accepted) {
    (accepted ? context.connections : context.rejected)++;
    if (accepted) context.connections_by_address[address]++;
  }
  ConnectionSlot(ConnectionSlot&& other) noexcept
      : context_(std::exchange(other.context_, nullptr)), address_(other.address_), accepted_(other.accepted_) {}
  ConnectionSlot& operator=(ConnectionSlot&&) = delete;
  ~ConnectionSlot() {
    if (context_ == nullptr) return;
    (accepted_ ? context_->connections : context_->rejected)--;
    if (!accepted_) return;
    const auto used = context_->connections_by_address.find(address_);
    if (--used->second == 0) context_->connections_by_address.erase(used);
  }

 private:
  ConnectionContext* context_;
  system::IpAddress address_;
  bool accepted_;
};

/// Serves a client for the whole lifetime of its connection. `context` must outlive the io_context's handlers.
void serve_connection(boost::asio::ip::tcp::socket socket, ConnectionContext& context);

}  // namespace limber::oscquery
