// TcpPeers: non-blocking sockets; each pass tries all of them, because there are few.
#include "net/osc/tcp/tcp_peers.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/net/tcp_socket.h"
#include "base/text.h"

namespace limber::osc {

namespace {

constexpr std::int64_t kRetryListen = 1'000'000'000;  // ns
constexpr std::int64_t kRetryAccept = 100'000'000;    // ns
constexpr std::size_t kBytesPerPass = 65536;          // read from a connection, so that none delays the others
constexpr const char* kTcpHint = "Choose another port with --osc-tcp ADDR:PORT, or continue with --osc-optional";

}  // namespace

std::vector<std::string> TcpPeers::listen(const std::vector<ListenAddress>& addresses) {
  addresses_ = addresses;
  std::vector<std::string> errors;
  for (const ListenAddress& address : addresses) {
    if (std::ranges::find(listeners_, address, &Listener::address) != listeners_.end()) continue;
    const std::string name = host_port_text(printable(address.address), address.port);
    const Result<Endpoint> at = resolve(address.address, address.port);
    Result<system::Descriptor> socket = at ? system::listen_tcp(*at) : Error{at.error()};
    if (!socket) {
      errors.push_back(fmt::format("OSC can't listen on {} (TCP): {}. {}", name, socket.error(), kTcpHint));
      continue;
    }
    if (at->ip.is_any()) log_warning("OSC in {} (TCP): open to the network", name);
    listeners_.push_back({address, std::move(*socket)});
  }
  // host names are not tried again, because a look-up may take seconds
  const bool numbers = std::ranges::all_of(addresses, [](const auto& a) { return system::is_ip_address(a.address); });
  retry_at_.reset();
  if (!errors.empty() && numbers) retry_at_ = clock_.steady() + kRetryListen;
  return errors;
}

void TcpPeers::close() {
  listeners_.clear();
  for (const std::unique_ptr<Connection>& connection : connections_) write(*connection);
  connections_.clear();
  retry_at_.reset();
}

std::vector<Endpoint> TcpPeers::bound() const {
  std::vector<Endpoint> list;
  for (const Listener& listener : listeners_) list.push_back(system::local_endpoint(listener.socket.fd()));
  return list;
}

void TcpPeers::add_poll_entries(std::vector<system::PollEntry>& list) const {
  for (const Listener& listener : listeners_) list.push_back({.fd = accept_again_ ? -1 : listener.socket.fd()});
  for (const std::unique_ptr<Connection>& connection : connections_)
    list.push_back({.fd = connection->socket.fd(), .read = true, .write = !connection->output.empty()});
}

std::optional<std::int64_t> TcpPeers::timeout() const {
  std::optional<std::int64_t> timeout;
  for (const std::optional<std::int64_t>& at : {retry_at_, accept_again_}) {
    if (!at) continue;
    const std::int64_t left = std::max<std::int64_t>(0, *at - clock_.steady());
    timeout = std::min(timeout.value_or(left), left);
  }
  return timeout;
}

bool TcpPeers::work() {
  const std::size_t open = listeners_.size();
  if (retry_at_ && *retry_at_ <= clock_.steady()) (void)listen(std::vector<ListenAddress>(addresses_));
  if (accept_again_ && *accept_again_ <= clock_.steady()) accept_again_.reset();
  for (const Listener& listener : listeners_) accept_connections(listener.socket);
  for (std::size_t i = 0; i < connections_.size(); i++) {
    read(*connections_[i]);
    write(*connections_[i]);
  }
  std::vector<Endpoint> ended;
  for (const std::unique_ptr<Connection>& connection : connections_) {
    if (connection->ended) ended.push_back(connection->peer);
  }
  std::erase_if(connections_, [](const auto& connection) { return connection->ended; });
  for (const Endpoint& peer : ended) callbacks_.closed(peer);
  return listeners_.size() != open;
}

TcpPeers::Connection* TcpPeers::find(const Endpoint& peer) const {
  const auto found = std::ranges::find_if(connections_, [&](const auto& c) { return c->peer == peer && !c->ended; });
  return found == connections_.end() ? nullptr : found->get();
}

void TcpPeers::accept_connections(const system::Descriptor& listener) {
  while (!accept_again_) {
    system::TcpConnection accepted = system::accept_tcp(listener);
    if (!accepted.socket.is_open()) {
      if (errno == EINTR || errno == ECONNABORTED) continue;
      if (errno != EAGAIN) accept_again_ = clock_.steady() + kRetryAccept;
      return;
    }
    if (!callbacks_.is_allowed(accepted.peer.ip)) {
      if (const auto more = denied_log_.admit(clock_.steady()))
        log_warning("OSC by TCP from {} rejected: its address is not in --osc-allow{}", endpoint_text(accepted.peer),
                    *more);
      continue;
    }
    if (connections_.size() >= kMaxConnections) {
      if (const auto more = full_log_.admit(clock_.steady()))
        log_warning("OSC by TCP from {} rejected: {} clients are connected; close one{}", endpoint_text(accepted.peer),
                    kMaxConnections, *more);
      continue;
    }
    connections_.push_back(std::make_unique<Connection>());
    connections_.back()->socket = std::move(accepted.socket);
    connections_.back()->peer = accepted.peer;
  }
}

void TcpPeers::read(Connection& connection) {
  std::array<char, kBytesPerPass> bytes;
  const std::ptrdiff_t count = system::receive_bytes(connection.socket.fd(), bytes.data(), bytes.size());
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) connection.ended = true;
  if (count <= 0) return;
  connection.input.append({bytes.data(), static_cast<std::size_t>(count)});
  for (;;) {
    const Result<std::optional<std::string>> packet = connection.input.next();
    if (!packet) {
      connection.ended = true;
      if (const auto more = malformed_log_.admit(clock_.steady()))
        log_warning("OSC by TCP from {}: {}; the connection is closed{}", endpoint_text(connection.peer),
                    packet.error(), *more);
      return;
    }
    if (!*packet) return;
    callbacks_.receive(connection.peer, **packet);
  }
}

void TcpPeers::write(Connection& connection) {
  std::size_t written = 0;
  while (written < connection.output.size()) {
    const std::ptrdiff_t count =
        system::send_bytes(connection.socket.fd(), std::string_view(connection.output).substr(written));
    if (count > 0) {
      written += static_cast<std::size_t>(count);
    } else if (count == 0 || errno == EAGAIN) {
      break;
    } else if (errno != EINTR) {
      connection.ended = true;
      break;
    }
  }
  connection.output.erase(0, written);
}

int TcpPeers::send(const Endpoint& to, std::span<const char> packet) {
  Connection* const connection = find(to);
  if (connection == nullptr) return ENOTCONN;
  if (connection->output.size() + packet.size() > kMaxUnsent) return ENOBUFS;
  const bool was_empty = connection->output.empty();
  append_framed(connection->input.framing(), packet, connection->output);
  if (was_empty) write(*connection);  // else work() writes it when the socket has room
  return 0;
}

}  // namespace limber::osc
