// Sends two queries after the message, one after the other. The second is answered in a later tick, when the scene's
// own handlers have processed the message too; then all replies have arrived. The queries have a socket of their own,
// so that their answers can't be confused with those of the message.
#include "app/commands/commands.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/send_arguments.h"
#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/system/clock.h"
#include "base/system/net/udp_socket.h"
#include "base/system/wait.h"
#include "base/text.h"
#include "engine/output/message_log.h"
#include "net/osc/endpoint.h"
#include "net/osc/packets/decode.h"
#include "net/osc/packets/encode.h"

namespace limber::app {

namespace {

// answered by another thread than the simulation's
constexpr const char* kDelayedReplies[] = {"/transport/scene", "/list/scenes", "/take/play"};
constexpr const char* kProbeAddress = "/physics/sim/tick";  // queried after the message

Result<system::Endpoint> endpoint_named(const std::string& text) {
  const system::HostPort parts = system::split_host_port(text);
  const std::string host = parts.host.empty() ? "127.0.0.1" : std::string(parts.host);
  const std::optional<double> port = parse_number(parts.port);
  if (!port || *port < 1 || *port > 65535 || *port != static_cast<std::uint16_t>(*port))
    return Error{fmt::format("--to '{}' is not an address; write --to [HOST:]PORT", printable(text))};
  Result<system::Endpoint> at = system::resolve(host, static_cast<std::uint16_t>(*port));
  if (!at) return Error{fmt::format("--to '{}': {}", printable(text), at.error())};
  return at;
}

// Returns the messages of the datagrams that have arrived; invalid packets are ignored.
std::vector<Message> receive(int fd) {
  std::vector<Message> messages;
  std::vector<char> bytes(65536);
  for (system::PollEntry waiting{.fd = fd}; system::wait_ready({&waiting, 1}, std::chrono::nanoseconds(0));) {
    const std::ptrdiff_t got = system::receive_bytes(fd, bytes.data(), bytes.size());
    if (got <= 0) break;
    Result<osc::Decoded> decoded = osc::decode_packet(bytes.data(), static_cast<std::size_t>(got));
    if (decoded) std::ranges::move(decoded->messages, std::back_inserter(messages));
  }
  return messages;
}

struct Replies {
  bool queries_answered = false;  // all immediate replies have arrived
  bool complete = false;          // all replies have arrived
  bool rejected = false;
};

// Prints the replies to the message that arrive at `fd`, until both queries are answered at `query_fd`.
// `delayed`: the reply comes from another thread, after the replies to the queries
Replies show_replies(int fd, int query_fd, double wait, bool delayed, const std::function<void()>& query) {
  Replies replies;
  int queries = 1;
  bool reply_seen = !delayed;
  query();
  const double end = system::clock_seconds() + wait;
  while (!replies.complete && system::clock_seconds() < end) {
    std::array<system::PollEntry, 2> sockets = {system::PollEntry{.fd = fd}, system::PollEntry{.fd = query_fd}};
    const std::chrono::duration<double> left(std::max(end - system::clock_seconds(), 0.0));
    (void)system::wait_ready(sockets, std::chrono::ceil<std::chrono::milliseconds>(left));
    for (const Message& message : receive(query_fd)) {
      if (message.address != kProbeAddress) continue;
      replies.queries_answered = queries == 2;
      if (queries++ == 1) query();
    }
    for (const Message& message : receive(fd)) {
      reply_seen = true;
      if (message.address == "/error" && message.args.size() == 2) {
        replies.rejected = true;
        print_notice("{}: {}", printable(message.args[0].text), printable(message.args[1].text));
      } else {
        print_result("{}\n", engine::message_text(message));
      }
    }
    replies.complete = replies.queries_answered && reply_seen;
  }
  return replies;
}

// `tags`: as in SendCommand
bool send_message(int fd, const system::Endpoint& to, const Message& message, std::string_view tags) {
  osc::PacketBuffer buffer;
  const std::span<const char> packet =
      tags.empty() ? osc::encode_message(message, buffer) : osc::encode_tagged(message, tags, buffer);
  return !packet.empty() && system::send_datagram(fd, to, packet) == 0;
}

}  // namespace

int send_command(const SendCommand& command) {
  Message message{command.address, {}};
  if (!message.address.starts_with('/'))
    return fail(kUsageError, fmt::format("send: address '{}' must begin with /", message.address));
  if (command.tags.empty()) {
    for (const std::string& word : command.words) message.args.push_back(parse_arg(word));
  } else {
    Result<Message> tagged = tagged_message(command.address, command.tags, command.words);
    if (!tagged) return fail(kUsageError, "send: " + tagged.error());
    message = std::move(*tagged);
  }
  const Result<system::Endpoint> to = endpoint_named(command.to);
  if (!to) return fail(kUsageError, "send: " + to.error());
  const system::Endpoint any{to->ip.is_v6 ? system::IpAddress(0, 0) : system::IpAddress(), 0};
  const Result<system::UdpSocket> socket = system::open_udp(any);
  if (!socket) return fail(kMachineError, "send: " + socket.error());
  const Result<system::UdpSocket> queries = system::open_udp(any);
  if (!queries) return fail(kMachineError, "send: " + queries.error());
  if (!send_message(socket->fd(), *to, message, command.tags)) {
    return fail(kMachineError,
                fmt::format("send: the message could not be sent to {}. Check its length and the address", command.to));
  }
  if (command.wait <= 0) return kSuccess;
  const auto query = [&] { (void)send_message(queries->fd(), *to, {"/get", {Arg::of(kProbeAddress)}}, {}); };
  const bool delayed =
      std::ranges::any_of(kDelayedReplies, [&](const char* start) { return message.address.starts_with(start); });
  const Replies replies = show_replies(socket->fd(), queries->fd(), command.wait, delayed, query);
  if (replies.rejected) return kInputError;
  if (!replies.queries_answered) {
    return fail(kMachineError,
                fmt::format("send: no reply from {}. Is Limber running there? (--wait 0 doesn't wait for a reply)",
                            command.to));
  }
  return kSuccess;
}

}  // namespace limber::app
