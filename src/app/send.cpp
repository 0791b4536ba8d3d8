// Two questions behind the message, one after the other: the second is answered in a later tick, when the scene's own
// handlers have heard the message too; then all answers have come.
#include "app/send.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/tagged_message.h"
#include "base/output.h"
#include "base/system/clock.h"
#include "base/system/udp_socket.h"
#include "base/system/wait.h"
#include "base/text.h"
#include "engine/traffic.h"
#include "osc/decode.h"
#include "osc/encode.h"
#include "osc/endpoint.h"
#include "osc/validate.h"

namespace limber {

namespace {

// answered from beside the simulation
constexpr const char* kAnsweredLate[] = {"/transport/scene", "/list/scenes", "/take/play"};
constexpr const char* kLast = "/physics/sim/tick";  // asked for behind the message

Result<Endpoint> endpoint_named(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string host = colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon);
  const std::optional<double> port = parse_number(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535 || *port != static_cast<std::uint16_t>(*port))
    return Error{fmt::format("--to '{}' is no place to send to; write --to [HOST:]PORT", printable(text))};
  Result<Endpoint> at = resolve(host, static_cast<std::uint16_t>(*port));
  if (!at) return Error{fmt::format("--to '{}': {}", printable(text), at.error())};
  return at;
}

// what came in one datagram; messages that are none are nobody's answer
std::vector<Message> receive(int fd, double seconds) {
  system::Waiting waiting{.fd = fd};
  const auto limit = std::chrono::milliseconds(static_cast<int>(std::max(seconds, 0.0) * 1000) + 1);
  if (!system::wait_ready({&waiting, 1}, limit)) return {};
  std::vector<char> bytes(65536);
  const std::ptrdiff_t got = system::receive_bytes(fd, bytes.data(), bytes.size());
  if (got <= 0 || packet_fault(bytes.data(), static_cast<std::size_t>(got)) != nullptr) return {};
  Result<Decoded> decoded = decode_packet(bytes.data(), static_cast<std::size_t>(got));
  return decoded ? std::move(decoded->messages) : std::vector<Message>();
}

struct Replies {
  bool last = false;   // of what is answered at once nothing more will come
  bool whole = false;  // nor anything else
  bool refused = false;
};

// `late`: what is waited for comes from beside the simulation, later than answers to what was asked behind it
Replies show_answers(int fd, double wait, bool late, const std::function<void()>& ask) {
  Replies answers;
  int asked = 1;
  bool heard = !late;
  ask();
  const double end = system::clock_seconds() + wait;
  while (!answers.whole && system::clock_seconds() < end) {
    for (const Message& message : receive(fd, end - system::clock_seconds())) {
      if (message.address == kLast) {
        answers.last = asked == 2;
        if (asked++ == 1) ask();
        continue;
      }
      heard = true;
      if (message.address == "/error" && message.args.size() == 2) {
        answers.refused = true;
        print_notice("{}: {}", printable(message.args[0].text), printable(message.args[1].text));
      } else {
        print_result("{}\n", message_text(message));
      }
    }
    answers.whole = answers.last && heard;
  }
  return answers;
}

// `tags`: as in SendCommand
bool send_message(int fd, const Endpoint& to, const Message& message, std::string_view tags) {
  PacketBuffer buffer;
  const std::span<const char> packet =
      tags.empty() ? encode_message(message, buffer) : encode_tagged(message, tags, buffer);
  return !packet.empty() && system::send_datagram(fd, to, packet) == 0;
}

}  // namespace

Arg arg_of(const std::string& word) {
  const bool quoted = word.size() >= 2 && (word.front() == '\'' || word.front() == '"') && word.back() == word.front();
  if (quoted) return Arg::of(std::string_view(word).substr(1, word.size() - 2));
  if (word == "true" || word == "false") return Arg::of(word == "true");
  const std::optional<double> number = parse_number(word);
  return number ? Arg::of(*number) : Arg::of(word);
}

int send_command(const SendCommand& command) {
  Message message{command.address, {}};
  if (!message.address.starts_with('/'))
    return fail(kUsage, fmt::format("send: '{}' is no address: it must begin with /", message.address));
  if (command.tags.empty()) {
    for (const std::string& word : command.words) message.args.push_back(arg_of(word));
  } else {
    Result<Message> tagged = tagged_message(command.address, command.tags, command.words);
    if (!tagged) return fail(kUsage, "send: " + tagged.error());
    message = std::move(*tagged);
  }
  const Result<Endpoint> to = endpoint_named(command.to);
  if (!to) return fail(kUsage, "send: " + to.error());
  const Result<system::UdpSocket> socket = system::open_udp({});
  if (!socket) return fail(kMachine, "send: " + socket.error());
  if (!send_message(socket->fd(), *to, message, command.tags)) {
    return fail(
        kMachine,
        fmt::format("send: the message could not be sent to {}; is it too long, or the address wrong?", command.to));
  }
  if (command.wait <= 0) return kFine;
  const auto ask = [&] { (void)send_message(socket->fd(), *to, {"/get", {Arg::of(kLast)}}, {}); };
  const bool late =
      std::ranges::any_of(kAnsweredLate, [&](const char* start) { return message.address.starts_with(start); });
  const Replies answers = show_answers(socket->fd(), command.wait, late, ask);
  if (answers.refused) return kInput;
  if (!answers.last) {
    return fail(
        kMachine,
        fmt::format("send: nobody answers at {}; is Limber playing there? (--wait 0 asks for no answer)", command.to));
  }
  return kFine;
}

}  // namespace limber
