// A connection: HTTP requests one after the other, or, after an upgrade, a WebSocket. Boost.Beast reads and checks what
// comes in; limits on sizes, counts and times are here. [query]
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include <boost/asio/ip/tcp.hpp>

#include "query/hall.h"

namespace limber {

/// Limits on what one client may ask of us.
struct QueryLimits {
  static constexpr int kConnections = 256;
  static constexpr int kOfOneAddress = 64;                         ///< So that no client takes all of them.
  static constexpr std::uint32_t kHeader = 8192;                   ///< Bytes of a request's head.
  static constexpr std::size_t kFrame = std::size_t{64} << 10;     ///< Bytes of a WebSocket message that comes in.
  static constexpr std::size_t kQueue = std::size_t{1} << 20;      ///< Bytes that wait for a client; more: it goes.
  static constexpr std::size_t kAnswers = std::size_t{256} << 20;  ///< Bytes of all answers that are on their way.
  static constexpr int kSendBuffer = 64 << 10;                     ///< Of a WebSocket, bytes.
  static constexpr int kReadSeconds = 10;                          ///< For a request to come.
  static constexpr int kWriteSeconds = 5;                          ///< For a client to take anything at all.
  static constexpr int kIdleSeconds = 60;                          ///< For a WebSocket to give a sign of life.
};

/// What connections share.
struct QueryDesk {
  Hall& hall;
  int seats = 0;
  std::map<std::uint32_t, int> seats_of = {};  ///< By address.
  int turned_away = 0;                         ///< Connections that are told why they can't stay.
  std::size_t answering = 0;                   ///< Bytes of answers on their way.

  bool full(std::uint32_t address) const {
    const auto taken = seats_of.find(address);
    return seats >= QueryLimits::kConnections ||
           (taken != seats_of.end() && taken->second >= QueryLimits::kOfOneAddress);
  }
};

/// Counts what is open, as long as it lives.
class Seat {
 public:
  /// `stays`: it counts among those of its address.
  Seat(QueryDesk& desk, std::uint32_t address, bool stays) : desk_(&desk), address_(address), stays_(stays) {
    (stays ? desk.seats : desk.turned_away)++;
    if (stays) desk.seats_of[address]++;
  }
  Seat(Seat&& other) noexcept
      : desk_(std::exchange(other.desk_, nullptr)), address_(other.address_), stays_(other.stays_) {}
  Seat& operator=(Seat&&) = delete;
  ~Seat() {
    if (desk_ == nullptr) return;
    (stays_ ? desk_->seats : desk_->turned_away)--;
    if (!stays_) return;
    const auto taken = desk_->seats_of.find(address_);
    if (--taken->second == 0) desk_->seats_of.erase(taken);
  }

 private:
  QueryDesk* desk_;
  std::uint32_t address_;
  bool stays_;
};

/// Serves a client from its first byte to its last. `desk` outlives the io_context's handlers.
void serve_connection(boost::asio::ip::tcp::socket socket, QueryDesk& desk);

}  // namespace limber
