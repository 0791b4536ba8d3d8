// A client for HTTP and WebSocket on plain sockets, based only on RFC 7230 and RFC 6455.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace limber::oscquery::test {

/// Timeout of all waits; reached only by failing tests.
inline constexpr int kTimeoutMs = 20000;

struct Reply {
  int status = 0;  ///< 0: no response.
  std::string head;
  std::string body;

  bool has_header(std::string_view line) const { return head.find(line) != std::string::npos; }
};

struct Frame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 10 pong; 0: no frame.
  std::string payload;
};

class WebClient {
 public:
  /// `host`: last byte of the client's own address, 127.0.0.1 and so on.
  explicit WebClient(std::uint16_t port, int receive_buffer = 0, std::uint32_t host = 1) : port_(port) {
    fd_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK - 1 + host);
    EXPECT_TRUE(host == 1 || bind(fd_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0);
    if (receive_buffer > 0) setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(port);
    EXPECT_EQ(connect(fd_, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0) << "port " << port;
  }
  ~WebClient() { close(); }
  WebClient(WebClient&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), port_(other.port_), buffer_(std::move(other.buffer_)) {}
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }
  int fd() const { return fd_; }
  /// The local port, by which the server identifies it.
  std::uint16_t own_port() const {
    sockaddr_in at{};
    socklen_t length = sizeof at;
    getsockname(fd_, reinterpret_cast<sockaddr*>(&at), &length);
    return ntohs(at.sin_port);
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  /// Returns false if the server accepted no more bytes.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }

  /// Sends a request and returns the response; `more` are further header lines, each with its line end.
  Reply get(std::string_view target, const std::string& more = "", std::string_view method = "GET") {
    send(std::string(method) + " " + std::string(target) + " HTTP/1.1\r\nHost: " + host() + "\r\n" + more + "\r\n");
    return reply(method == "HEAD");
  }
  Reply reply(bool head_only = false) {
    Reply reply;
    std::size_t end = 0;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
      if (!read_more()) return reply;
    }
    reply.head = buffer_.substr(0, end + 2);
    buffer_.erase(0, end + 4);
    reply.status = std::atoi(reply.head.c_str() + std::string_view("HTTP/1.1 ").size());
    const std::size_t length = reply.head.find("Content-Length: ");
    const std::size_t size = length == std::string::npos || head_only ? 0 : std::stoul(reply.head.substr(length + 16));
    while (buffer_.size() < size) {
      if (!read_more()) break;
    }
    reply.body = buffer_.substr(0, size);
    buffer_.erase(0, size);
    return reply;
  }

  /// Upgrades to a WebSocket; the expected status is 101. The key and the expected reply to it are those of RFC 6455.
  Reply upgrade(const std::string& more = "") {
    return get("/",
               "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   more);
  }
  /// Sends a masked frame, as required of clients.
  bool frame(int opcode, std::string_view payload, bool last = true) const {
    std::string bytes(1, static_cast<char>((last ? 0x80 : 0) | opcode));
    if (payload.size() < 126) {
      bytes += static_cast<char>(0x80 | payload.size());
    } else if (payload.size() < 65536) {
      bytes += static_cast<char>(0x80 | 126);
      for (const int shift : {8, 0}) bytes += static_cast<char>(payload.size() >> shift & 255u);
    } else {
      bytes += static_cast<char>(0x80 | 127);
      for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(payload.size() >> shift & 255u);
    }
    const std::string mask = "\x12\x34\x56\x78";
    bytes += mask;
    for (std::size_t i = 0; i < payload.size(); i++) bytes += static_cast<char>(payload[i] ^ mask[i % 4]);
    return send(bytes);
  }
  bool text(std::string_view payload) const { return frame(1, payload); }
  bool binary(std::string_view payload) const { return frame(2, payload); }
  bool listen(std::string_view path) const { return command("LISTEN", path); }
  bool ignore(std::string_view path) const { return command("IGNORE", path); }
  bool command(std::string_view word, std::string_view path) const {
    return text(R"({"COMMAND":")" + std::string(word) + R"(","DATA":")" + std::string(path) + "\"}");
  }

  /// Returns the next frame; its opcode is 0 on timeout or if the connection ended.
  Frame receive(int ms = kTimeoutMs) {
    Frame frame;
    while (!parse_frame(frame)) {
      if (!read_more(ms)) return {};
    }
    return frame;
  }
  /// Returns the next frame with this opcode that contains `part`, skipping others.
  Frame receive(int opcode, std::string_view part) {
    for (;;) {
      Frame frame = receive();
      if (frame.opcode == 0 || (frame.opcode == opcode && frame.payload.find(part) != std::string::npos)) return frame;
    }
  }
  /// Returns the binary frames that arrive before the pong of this ping, which are all that were on their way.
  std::vector<std::string> until_pong(const std::string& word) {
    frame(9, word);
    std::vector<std::string> values;
    for (;;) {
      Frame got = receive();
      if (got.opcode == 0) ADD_FAILURE() << "the ping is not answered";
      if (got.opcode == 0 || (got.opcode == 10 && got.payload == word)) return values;
      if (got.opcode == 2) values.push_back(std::move(got.payload));
    }
  }
  /// True if the server closes the connection.
  bool is_closed() {
    while (read_more()) buffer_.clear();
    return ended_;
  }

 private:
  // Reads some bytes; returns false if no more arrive.
  bool read_more(int ms = kTimeoutMs) {
    pollfd p{fd_, POLLIN, 0};
    if (poll(&p, 1, ms) <= 0) return false;
    char buffer[65536];
    const ssize_t n = recv(fd_, buffer, sizeof buffer, 0);
    ended_ = n <= 0;
    if (n > 0) buffer_.append(buffer, static_cast<std::size_t>(n));
    return n > 0;
  }

  bool parse_frame(Frame& frame) {
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(buffer_[i]); };
    if (buffer_.size() < 2) return false;
    std::size_t head = 2;
    std::size_t size = byte(1) & 127u;
    EXPECT_EQ(byte(1) & 128u, 0u) << "a server's frame is not masked";
    const std::size_t longer = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (buffer_.size() < head + longer) return false;
    if (longer > 0) size = 0;
    for (std::size_t i = 0; i < longer; i++) size = size << 8 | byte(head + i);
    head += longer;
    if (buffer_.size() < head + size) return false;
    frame.opcode = byte(0) & 15;
    frame.payload = buffer_.substr(head, size);
    buffer_.erase(0, head + size);
    return true;
  }

  int fd_ = -1;
  std::uint16_t port_ = 0;
  std::string buffer_;
  bool ended_ = false;
};

}  // namespace limber::oscquery::test
