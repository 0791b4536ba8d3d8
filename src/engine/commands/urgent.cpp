// Addresses of urgent requests and of the requests that they discard.
#include "engine/commands/urgent.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace limber::engine {

namespace {

struct UrgentAddress {
  std::string_view address;
  UrgentKind kind;
};

// The addresses of both tables are in the form of normalized_name(): lower case, without underscores.
constexpr std::array kUrgent = {
    UrgentAddress{"/transport/panic", UrgentKind::panic}, UrgentAddress{"/physics/sim/panic", UrgentKind::panic},
    UrgentAddress{"/transport/panicend", UrgentKind::panic_end}, UrgentAddress{"/transport/pause", UrgentKind::pause},
    UrgentAddress{"/take/stop", UrgentKind::take_stop}};

constexpr unsigned bit(UrgentKind kind) { return 1u << static_cast<unsigned>(kind); }
constexpr unsigned kPanic = bit(UrgentKind::panic);
constexpr unsigned kPause = bit(UrgentKind::pause);
constexpr unsigned kTakeStop = bit(UrgentKind::take_stop);

struct DiscardableRequest {
  std::string_view address;
  unsigned discarded_by;
};

constexpr std::array kDiscardable = {DiscardableRequest{"/transport/play", kPanic | kPause},
                                     DiscardableRequest{"/transport/step", kPanic | kPause},
                                     DiscardableRequest{"/physics/sim/paused", kPanic | kPause},
                                     DiscardableRequest{"/take/play", kPanic | kPause | kTakeStop},
                                     DiscardableRequest{"/take/record", kPanic | kTakeStop},
                                     DiscardableRequest{"/transport/rewind", kPanic},
                                     DiscardableRequest{"/transport/rewindticks", kPanic},
                                     DiscardableRequest{"/transport/reset", kPanic},
                                     DiscardableRequest{"/physics/sim/reset", kPanic},
                                     DiscardableRequest{"/transport/scene", kPanic}};

unsigned discarded_by(const Message& message) {
  const auto* const found = std::ranges::find_if(
      kDiscardable, [&](const DiscardableRequest& request) { return same_address(message.address, request.address); });
  return found == kDiscardable.end() ? 0 : found->discarded_by;
}

}  // namespace

std::optional<UrgentKind> urgent_kind_of_address(std::string_view address) {
  for (const UrgentAddress& urgent : kUrgent) {
    if (same_address(address, urgent.address)) return urgent.kind;
  }
  return std::nullopt;
}

std::optional<UrgentKind> urgent_kind(const Message& message) {
  const std::optional<UrgentKind> kind = urgent_kind_of_address(message.address);
  if (!kind || message.args.size() > 1) return std::nullopt;
  if (message.args.empty() || message.args[0].kind == Arg::Kind::nil) return kind;
  const Arg& arg = message.args[0];
  const double value = arg.is_text() ? parse_number(arg.text).value_or(0) : arg.number;
  return value != 0 && std::isfinite(value) ? kind : std::nullopt;
}

bool UrgentPrecedence::discards(const Message& message, std::uint64_t arrival) const {
  if (arrival >= std::ranges::max(newest_)) return false;  // the common case
  const unsigned by = discarded_by(message);
  for (std::size_t kind = 0; by >> kind != 0; kind++) {
    if ((by >> kind & 1u) != 0 && arrival < newest_[kind]) return true;
  }
  return false;
}

bool UrgentPrecedence::discards(const Message& message, UrgentKind kind) {
  return (discarded_by(message) & bit(kind)) != 0;
}

}  // namespace limber::engine
