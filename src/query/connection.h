// A connection: HTTP requests one after the other, or, after an upgrade, a WebSocket. Boost.Beast reads and checks what
// comes in; limits on sizes, counts and times are here. [query]
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "query/hall.h"

namespace limber {

/// Limits on what one client may ask of us.
struct QueryLimits {
  static constexpr int kConnections = 256;
  static constexpr std::uint32_t kHeader = 8192;                   ///< Bytes of a request's head.
  static constexpr std::size_t kFrame = std::size_t{64} << 10;     ///< Bytes of a WebSocket message that comes in.
  static constexpr std::size_t kQueue = std::size_t{1} << 20;      ///< Bytes that wait for a client; more: it goes.
  static constexpr std::size_t kAnswers = std::size_t{256} << 20;  ///< Bytes of all answers that are on their way.
  static constexpr int kSendBuffer = 64 << 10;                     ///< Of a WebSocket, bytes.
  static constexpr int kReadSeconds = 10;                          ///< For a request to come.
  static constexpr int kWriteSeconds = 5;                          ///< For a client to take anything at all.
  static constexpr int kIdleSeconds = 60;                          ///< For a WebSocket to give a sign of life.
};

/// Counts what is open, as long as it lives.
class Seat {
 public:
  explicit Seat(int& taken) : taken_(&taken) { ++*taken_; }
  Seat(Seat&& other) noexcept : taken_(std::exchange(other.taken_, nullptr)) {}
  Seat& operator=(Seat&&) = delete;
  ~Seat() {
    if (taken_ != nullptr) --*taken_;
  }

 private:
  int* taken_;
};

/// What connections share.
struct QueryDesk {
  Hall& hall;
  int seats = 0;
  std::size_t answering = 0;  ///< Bytes of answers on their way.
};

/// Serves a client from its first byte to its last. `desk` outlives the io_context's handlers.
void serve_connection(boost::asio::ip::tcp::socket socket, QueryDesk& desk);

}  // namespace limber
