// Packets of PosiStageNet: the input is a list of packets, each after its length (two bytes), from changing senders.
// Messages name a tracker and have eight numbers; a quaternion is absent or has the length 1.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "fuzz/target.h"
#include "net/osc/psn/psn_input.h"

namespace {

using limber::Message;
using limber::must;

void check(const Message& message) {
  must(message.address == limber::osc::PsnInput::kAddress && message.args.size() == 9);
  must(!limber::name_error(message.args[0].text));
  double length = 0;
  for (std::size_t i = 4; i < 8; i++) length += message.args[i].number * message.args[i].number;
  must(std::isnan(length) || std::abs(length - 1) < 1e-6);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::osc::PsnInput input;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::int64_t now = 0;
  for (std::uint32_t sender = 0; bytes.size() > 2; sender = sender * 5 + 1) {
    const std::size_t length = static_cast<unsigned char>(bytes[0]) | static_cast<unsigned char>(bytes[1]) << 8U;
    bytes.remove_prefix(2);
    const std::string_view packet = bytes.substr(0, length);
    bytes.remove_prefix(packet.size());
    now += 700'000'000;
    const auto messages = input.translate(packet, sender % 11, now);
    must(messages || !messages.error().empty());
    must(!messages || messages->empty() || limber::osc::is_psn(packet));
    if (!messages) continue;
    for (const Message& message : *messages) check(message);
  }
  return 0;
}
