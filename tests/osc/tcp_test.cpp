// OSC by TCP: both framings, answers and streams by the connection, and clients that misbehave.
#include <gtest/gtest.h>

#include <sys/time.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/system/net/socket.h"
#include "net/osc/network.h"
#include "net/osc/tcp/framing.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

constexpr std::uint32_t kLoopback = 0x7f000001;

// RFC 1055, independently of the tested code
std::string slip(std::string_view packet) {
  std::string out = "\xc0";
  for (const char c : packet) {
    if (c == '\xc0') {
      out += "\xdb\xdc";
    } else if (c == '\xdb') {
      out += "\xdb\xdd";
    } else {
      out += c;
    }
  }
  return out + "\xc0";
}

std::string with_length(std::string_view packet) {
  return Bytes().u32(static_cast<std::uint32_t>(packet.size())).raw(packet).str();
}

std::string message(const std::string& address, float value) { return Bytes().text(address).text(",f").f(value).str(); }

// Splits bytes that arrive in pieces of this size; the last text is the error, if there is one.
std::vector<std::string> split_in_pieces(const std::string& bytes, std::size_t size) {
  PacketSplitter splitter;
  std::vector<std::string> packets;
  for (std::size_t i = 0; i < bytes.size(); i += size) {
    splitter.append(std::string_view(bytes).substr(i, size));
    for (;;) {
      const auto next = splitter.next();
      if (!next) {
        packets.push_back("error: " + next.error());
        return packets;
      }
      if (!*next) break;
      packets.push_back(**next);
    }
  }
  return packets;
}

TEST(PacketSplitter, ReadsBothFramingsInAnyPieces) {
  const std::vector<std::string> packets = {"/a\0\0,\0\0\0", std::string("\xc0\xdb\xdc\xdd\0\xc0\xc0", 7),
                                            std::string(5000, '\xdb')};
  for (const auto& frame : {slip, with_length}) {
    std::string bytes;
    for (const std::string& packet : packets) bytes += frame(packet);
    for (const std::size_t size : {std::size_t{1}, std::size_t{3}, std::size_t{100}, bytes.size()})
      EXPECT_EQ(split_in_pieces(bytes, size), packets) << size;
  }
}

TEST(PacketSplitter, WritesWhatItReads) {
  Random random(5);
  for (int i = 0; i < 50; i++) {
    std::string packet;
    for (int n = 1 + static_cast<int>(random.uniform(0, 200)); n > 0; n--)
      packet += static_cast<char>(static_cast<int>(random.uniform(0, 256)));
    std::string framed;
    append_framed(Framing::slip, packet, framed);
    EXPECT_EQ(framed, slip(packet));
    framed.clear();
    append_framed(Framing::length, packet, framed);
    EXPECT_EQ(framed, with_length(packet));
  }
}

TEST(PacketSplitter, RejectsLargePacketsAndWrongEscapes) {
  const auto last = [](const std::string& bytes) { return split_in_pieces(bytes, 7).back(); };
  EXPECT_EQ(last(Bytes().u32(65537).str()), "error: a packet of 65537 bytes or more; at most 65536 are accepted");
  EXPECT_EQ(last(slip(std::string(70000, 'x'))), "error: a packet of 65537 bytes or more; at most 65536 are accepted");
  EXPECT_EQ(last("\xc0/a\xdbx"), "error: a wrong escape sequence of SLIP, byte 120");
  EXPECT_EQ(last(with_length(std::string(65536, 'x'))).size(), 65536u);
}

// A client that is connected to the network thread.
class TcpClient {
 public:
  explicit TcpClient(const Endpoint& to) : socket_(system::connect_tcp(to)) {
    EXPECT_TRUE(socket_.is_open());
    const timeval limit = {kTimeoutMs / 1000, 0};
    setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  }
  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const std::ptrdiff_t sent = system::send_bytes(socket_.fd(), bytes);
      if (sent <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  /// The next packet; empty if the connection ended or none arrived in time.
  std::string receive() {
    for (;;) {
      const auto packet = input_.next();
      EXPECT_TRUE(packet.ok());
      if (!packet) return {};
      if (*packet) return **packet;
      std::array<char, 4096> bytes;
      const std::ptrdiff_t count = system::receive_bytes(socket_.fd(), bytes.data(), bytes.size());
      if (count <= 0) return {};
      input_.append({bytes.data(), static_cast<std::size_t>(count)});
    }
  }
  Framing framing() const { return input_.framing(); }
  Endpoint end() const { return system::local_endpoint(socket_.fd()); }
  void close() { socket_ = {}; }

 private:
  system::Descriptor socket_;
  PacketSplitter input_;
};

struct TcpFixture {
  explicit TcpFixture(const std::string& allow = "") : network(engine.link, options(allow), kTestOffsets) {
    const Result<void> started = network.start();
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error());
    end = network.bound_tcp().at(0);
  }
  static OscOptions options(const std::string& allow) {
    OscOptions options;
    options.in.emplace();
    options.out.emplace();
    options.tcp = *parse_listen("--osc-tcp", "0");
    if (!allow.empty()) options.allow = *parse_osc_allow(allow);
    return options;
  }
  FakeEngine engine;
  Network network;
  Endpoint end;
};

bool is_pong(const std::string& packet) { return packet.starts_with("/pong"); }

TEST(OscTcp, MessagesArriveAndAnswersUseTheSameFraming) {
  TcpFixture fixture;
  std::size_t expected = 0;
  for (const auto& frame : {slip, with_length}) {
    TcpClient client(fixture.end);
    client.send(frame(message("/scene/wind", 2)) + frame(message("/scene/wind", 3)));
    expected += 2;
    ASSERT_TRUE(fixture.engine.wait_for(expected));
    const engine::Command& last = fixture.engine.commands.back();
    EXPECT_EQ(last.origin.port, client.end().port);
    EXPECT_EQ(last.messages.back().args[0].number, 3);
    client.send(frame(Bytes().text("/ping").text(",").str()));
    EXPECT_TRUE(is_pong(client.receive()));
    EXPECT_EQ(client.framing(), frame("") == slip("") ? Framing::slip : Framing::length);
  }
  const std::vector<std::string> lines = fixture.network.status_lines();
  EXPECT_EQ(lines.at(0), "OSC in " + endpoint_text(fixture.end) + " (TCP)");
}

TEST(OscTcp, RepliesAndErrorsOfTheEngineGoToTheConnection) {
  TcpFixture fixture;
  TcpClient client(fixture.end);
  client.send(slip(message("/scene/wind", 1)));
  ASSERT_TRUE(fixture.engine.wait_for(1));
  const CommandOrigin origin = fixture.engine.commands[0].origin;
  fixture.engine.push_out({engine::Outgoing::Destination::reply, origin, {"/scene/wind", {Arg::of(4.0)}}});
  EXPECT_EQ(client.receive(), message("/scene/wind", 4));
  fixture.engine.push_out({engine::Outgoing::Destination::error, origin, engine::error_message("/x", "no such")});
  EXPECT_TRUE(client.receive().starts_with("/error"));
}

TEST(OscTcp, StreamsGoToTheConnectionAndEndWithIt) {
  TcpFixture fixture;
  const auto spare = fixture.engine.link.snapshots.acquire_buffer();
  *spare = test_world({{"arm", 3}});
  fixture.engine.link.snapshots.publish(spare);
  TcpClient client(fixture.end);
  client.send(slip(Bytes().text("/subscribe").text(",s").text("rot").str()));
  EXPECT_TRUE(client.receive().starts_with("/physics/joint/rot"));
  EXPECT_TRUE(client.receive().starts_with("/physics/joint/rot"));
  const Endpoint peer = client.end();
  client.close();
  // a datagram socket with the same number gets nothing once the connection has ended
  TcpClient other(fixture.end);
  for (int i = 0; i < 3; i++) {
    other.send(slip(Bytes().text("/ping").text(",").str()));
    EXPECT_TRUE(is_pong(other.receive()));
  }
  const auto socket = system::open_udp({kLoopback, peer.port});
  if (!socket) return;  // in use by another program
  other.send(slip(Bytes().text("/ping").text(",").str()));
  EXPECT_TRUE(is_pong(other.receive()));
  char byte = 0;
  EXPECT_EQ(system::receive_bytes(socket->fd(), &byte, 1), -1);
}

TEST(OscTcp, BadBytesEndOnlyTheirConnection) {
  TcpFixture fixture;
  TcpClient good(fixture.end);
  TcpClient large(fixture.end);
  TcpClient escape(fixture.end);
  TcpClient noise(fixture.end);
  large.send(Bytes().u32(1U << 20).str());
  escape.send("\xc0\xdb/");
  EXPECT_EQ(large.receive(), "");
  EXPECT_EQ(escape.receive(), "");
  noise.send(slip("no OSC") + slip(Bytes().text("/ping").text(",").str()));
  EXPECT_TRUE(is_pong(noise.receive())) << "a packet that is not OSC is skipped";
  good.send(slip(Bytes().text("/ping").text(",").str()));
  EXPECT_TRUE(is_pong(good.receive()));
  EXPECT_EQ(fixture.engine.link.counters.malformed.load(), 1u);
}

TEST(OscTcp, LimitsClientsAndSenders) {
  TcpFixture fixture;
  std::vector<std::unique_ptr<TcpClient>> clients;
  for (std::size_t i = 0; i < TcpPeers::kMaxConnections; i++) {
    clients.push_back(std::make_unique<TcpClient>(fixture.end));
    clients.back()->send(slip(Bytes().text("/ping").text(",").str()));
    ASSERT_TRUE(is_pong(clients.back()->receive()));
  }
  EXPECT_EQ(TcpClient(fixture.end).receive(), "") << "one too many";
  EXPECT_EQ(TcpClient(TcpFixture("192.168.1.0/24").end).receive(), "") << "not in --osc-allow";
}

TEST(OscTcp, AClientThatDoesNotReadDelaysNoOther) {
  TcpFixture fixture;
  TcpClient unread(fixture.end);
  TcpClient good(fixture.end);
  unread.send(slip(message("/scene/wind", 1)));
  ASSERT_TRUE(fixture.engine.wait_for(1));
  const CommandOrigin origin = fixture.engine.commands[0].origin;
  const std::string text(60000, 'x');
  // more than its buffers and the kernel's hold
  for (int i = 0; i < 400; i++)
    fixture.engine.push_out({engine::Outgoing::Destination::reply, origin, {"/text", {Arg::of(text)}}});
  good.send(slip(Bytes().text("/ping").text(",").str()));
  EXPECT_TRUE(is_pong(good.receive()));
  EXPECT_TRUE(unread.receive().starts_with("/text")) << "the first ones were kept";
  fixture.network.stop();
  EXPECT_GT(fixture.engine.link.counters.unsent.load(), 0u);
}

TEST(OscTcp, APortInUseIsAnErrorWithACorrection) {
  const TcpFixture first;
  FakeEngine engine;
  OscOptions options = TcpFixture::options("");
  options.tcp[0].port = first.end.port;
  Network second(engine.link, options, kTestOffsets);
  const Result<void> started = second.start();
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error(), "OSC can't listen on " + endpoint_text(first.end) +
                                 " (TCP): Address already in use. Choose another port with --osc-tcp ADDR:PORT, or "
                                 "continue with --osc-optional");
}

}  // namespace
}  // namespace limber::osc
