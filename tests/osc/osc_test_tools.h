// Tools of the OSC tests: a UDP client, a clock that tests control, and an inbox to wait for messages.
#pragma once

#include <poll.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/system/net/socket_address.h"
#include "base/system/net/udp_socket.h"
#include "engine/output/engine_link.h"
#include "net/osc/clock.h"
#include "net/osc/endpoint.h"
#include "osc/bytes.h"

namespace limber::osc::test {

/// Timeout of all waits; reached only by failing tests.
inline constexpr int kTimeoutMs = 20000;

/// A clock that advances only when a test sets it.
struct ManualClock {
  std::int64_t ns = 5'000'000'000;
  std::uint64_t ntp = std::uint64_t{3'900'000'000u} << 32;

  void advance(double seconds) {
    ns += static_cast<std::int64_t>(seconds * 1e9);
    ntp += static_cast<std::uint64_t>(seconds * 4294967296.0);
  }
  NetClock clock() {
    NetClock c;
    c.steady = [this] { return ns; };
    c.ntp = [this] { return ntp; };
    return c;
  }
};

/// A client's socket on this machine.
class Client {
 public:
  explicit Client(const IpAddress& at = 0x7f000001U) : socket_(std::move(system::open_udp({at, 0}).value())) {
    const int size = 4 << 20;
    setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  }

  Endpoint end() const { return socket_.local(); }
  void send(const Endpoint& to, std::string_view bytes) const {
    const system::SocketAddress address(to);
    sendto(socket_.fd(), bytes.data(), bytes.size(), 0, address.get(), address.length());
  }
  /// Returns the next datagram and its sender, or nothing if none arrives within `ms`.
  std::optional<std::string> receive(int ms = kTimeoutMs, Endpoint* from = nullptr) const {
    pollfd p{socket_.fd(), POLLIN, 0};
    if (poll(&p, 1, ms) <= 0) return std::nullopt;
    std::string bytes(65536, '\0');
    system::SocketAddress address;
    const auto size = recvfrom(socket_.fd(), bytes.data(), bytes.size(), 0, address.get(), address.receive_length());
    if (size < 0) return std::nullopt;
    if (from != nullptr) *from = address.endpoint();
    bytes.resize(static_cast<std::size_t>(size));
    return bytes;
  }

 private:
  system::UdpSocket socket_;
};

/// An engine link without an engine; collects incoming commands.
class FakeEngine {
 public:
  FakeEngine() {
    link.wake_engine = [this] {
      const std::scoped_lock lock(mutex_);
      notified_ = true;
      changed_.notify_all();
    };
  }

  /// Waits until this many messages have arrived in total; returns false on timeout.
  bool wait_for(std::size_t messages) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kTimeoutMs);
    for (;;) {
      collect();
      if (count() >= messages) return true;
      std::unique_lock lock(mutex_);
      if (!changed_.wait_until(lock, until, [this] { return notified_; })) return false;
      notified_ = false;
    }
  }
  void collect() {
    std::vector<engine::Command> batch;
    link.command_queue.drain(batch);
    for (engine::Command& c : batch) commands.push_back(std::move(c));
  }
  std::size_t count() const {
    std::size_t n = 0;
    for (const engine::Command& c : commands) n += c.messages.size();
    return n;
  }
  void push_out(engine::Outgoing out) {
    link.output_queue.push(std::move(out));
    link.wake_network();
  }

  engine::EngineLink link;
  std::vector<engine::Command> commands;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool notified_ = false;
};

}  // namespace limber::osc::test
