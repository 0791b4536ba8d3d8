// The receiver: listening sockets, and the way of a datagram: allowed, whole, decoded, then now or when it is due into
// the engine's inbox, all messages of a datagram as one command. Sockets are read ahead of decoding, so that urgent
// requests (engine/urgent.h) reach the engine however much waits before them.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/udp_socket.h"
#include "engine/link.h"
#include "osc/clock.h"
#include "osc/decode.h"
#include "osc/endpoint.h"
#include "osc/held.h"
#include "osc/options.h"
#include "osc/seldom.h"

namespace limber {

/// Where the receiver's own answers go.
struct ReceiverAnswers {
  std::function<void(const Outgoing&)> error = [](const Outgoing&) {};
  std::function<void(const Origin&)> pong = [](const Origin&) {};
  std::function<Result<void>(const Message&, const Origin&)> subscribe = [](const Message&, const Origin&) {
    return Result<void>();
  };
  std::function<bool(const Origin&)> follows = [](const Origin&) { return false; };
  /// A datagram has come by a socket.
  std::function<void(const Endpoint&, std::size_t bytes)> received = [](const Endpoint&, std::size_t) {};
  /// `/token` has come.
  std::function<void(const Message&, const Origin&)> token = [](const Message&, const Origin&) {};
  /// A message that may be the answer to an /error has come.
  std::function<void(const Origin&)> echo = [](const Origin&) {};
};

/// [net], but for what says otherwise
class Receiver {
 public:
  Receiver(EngineLink& link, std::vector<Cidr> allow, ReceiverAnswers answers, const NetClock& clock);
  ~Receiver();

  /// Opens what is new in the list, closes what is not in it, keeps the rest. The texts of what could not be opened.
  std::vector<std::string> listen(const std::vector<ListenAddress>& addresses);
  /// Whether one of them could not be opened and may be later. Names are left out: to look them up may take seconds.
  bool wants_more(const std::vector<ListenAddress>& addresses) const;
  void close();

  /// The sockets to poll, and where they are bound, in the order of opening.
  std::vector<int> descriptors() const;
  std::vector<Endpoint> bound() const;

  /// What is known of a packet before it is decoded.
  struct Scanned {
    std::uint64_t arrival = 0;  ///< As Command::arrival; 0: the inbox numbers it.
    bool urgent = false;        ///< Its urgent requests are with the engine.
  };
  static constexpr std::size_t kMostRaw = 16384;  ///< Datagrams that wait to be decoded.
  static constexpr std::size_t kMostRawBytes = std::size_t{16} << 20;
  static constexpr std::size_t kDecodedBytes = std::size_t{256} << 10;  ///< Of a call.

  /// Reads what waits in the socket, at most a thousand datagrams, so that streams get their turn. Call release_due()
  /// after it.
  void receive(int fd);
  /// Gives the engine a packet's urgent requests, unless it is denied, invalid or dated ahead of now. [any]
  Scanned scan(const char* data, std::size_t size, const Origin& origin) const;
  /// One datagram, as if it had come in by a socket. The fuzz target begins here.
  void take(const char* data, std::size_t size, const Endpoint& from) {
    take(data, size, {Hand::osc, from.ip, from.port});
  }
  /// A packet that came by another way.
  void take(const char* data, std::size_t size, Origin origin) { take(data, size, origin, {}); }
  void take(const char* data, std::size_t size, Origin origin, Scanned scanned);
  /// Decodes some of what was read, gives the engine the held bundles that are due, and wakes it when anything came
  /// since the last call.
  void release_due();
  std::optional<std::int64_t> wait() const { return raw_.empty() ? held_.wait() : 0; }

  /// The listening socket by which this sender's last message came, so that the answer comes from where the question
  /// went; -1 when it is forgotten.
  int socket_of(const Endpoint& sender) const;

 private:
  struct Listening;
  struct Known {
    Endpoint sender;
    int fd = -1;
  };
  static constexpr std::size_t kKnown = 256;  // a power of two

  std::optional<std::string> open(const ListenAddress& address);
  void take_from(Listening& socket, const char* data, std::size_t size, const Endpoint& from);
  void decode_some();
  void note_traffic(const Origin& origin, const Decoded& packet);
  void deliver(std::uint64_t time_tag, Command command, bool urgent_pushed);
  void push(Command command, bool urgent_pushed = false);
  void refuse(const Origin& origin, const std::string& address, const std::string& text);
  void note_kernel_drops(Listening& socket, std::uint32_t count);
  bool allowed(std::uint32_t ip) const;
  template <class Text>
  void warn_seldom(Seldom& kind, const Text& text);

  EngineLink& link_;
  std::vector<Cidr> allow_;
  ReceiverAnswers answers_;
  const NetClock& clock_;
  HeldCommands held_;
  std::vector<std::unique_ptr<Listening>> sockets_;
  system::DatagramReader reader_;
  struct Raw {
    std::string bytes;
    Endpoint from;
    Scanned scanned;
  };
  std::deque<Raw> raw_;  // read, not yet decoded
  std::size_t raw_bytes_ = 0;
  std::array<Known, kKnown> known_{};
  bool pushed_ = false;  // since the engine was woken
  bool said_buffer_ = false;
  Seldom malformed_, not_allowed_, inbox_full_, kernel_full_, far_, held_full_;
};

}  // namespace limber
