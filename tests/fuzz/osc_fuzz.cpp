// Arbitrary bytes through the way of a datagram: validator, oscpack, receiver, inbox. A world can stand behind the
// inbox in place of the checks below.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "base/log.h"
#include "osc/encode.h"
#include "osc/receiver.h"
#include "osc/validate.h"

namespace {

using namespace limber;

struct Desk {
  Desk() { log_to_stderr(false); }

  EngineLink link;
  NetClock clock;
  std::uint64_t answers = 0;
  Receiver receiver{link, {}, {[this](const Outgoing&) { answers++; }, [this](const Origin&) { answers++; }}, clock};
  std::vector<Command> commands;
  PacketBuffer buffer;
};

// a fault that no sanitizer sees
void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static Desk& desk = *new Desk;  // lives as long as the process
  const auto* data = reinterpret_cast<const char*>(bytes);
  const std::uint64_t malformed = desk.link.counters.malformed;
  const std::uint64_t received = desk.link.counters.received;
  const bool whole = packet_fault(data, size) == nullptr;
  desk.receiver.take(data, size, {0x7f000001, 5000});
  // oscpack takes whatever the validator has passed, and nothing comes of what it has not
  require(desk.link.counters.malformed - malformed == (whole ? 0u : 1u));
  require(whole || desk.link.counters.received == received);

  desk.link.inbox.drain(desk.commands);
  for (const Command& command : desk.commands) {
    for (const Message& message : command.messages) {
      require(!message.address.empty() && message.address[0] == '/');
      require(message.args.size() <= OscLimits::kMessageArguments);
      // what came in can be sent on
      const std::span<const char> packet = encode_message(message, desk.buffer);
      require(packet.empty() || packet_fault(packet.data(), packet.size()) == nullptr);
    }
  }
  return 0;
}
