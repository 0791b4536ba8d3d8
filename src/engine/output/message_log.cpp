// MessageLog: a bounded queue under a mutex, held for the time of a copy.
#include "engine/output/message_log.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/system/clock.h"
#include "base/text.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxShownArgs = 16;
constexpr std::size_t kMaxShownText = 200;

std::size_t weight_of(const LoggedMessage& entry) {
  std::size_t bytes = sizeof entry + entry.peer.size() + entry.message.address.size();
  for (const Arg& arg : entry.message.args) bytes += sizeof arg + arg.text.size();
  return bytes;
}

}  // namespace

void MessageLog::add(bool incoming, std::string peer, const Message& message) {
  LoggedMessage entry{0, system::clock_seconds(), incoming, std::move(peer), message};
  const std::size_t bytes = weight_of(entry);
  const std::scoped_lock lock(mutex_);
  entry.number = ++newest_;
  bytes_ += bytes;
  entries_.push_back(std::move(entry));
  while (entries_.size() > kMaxEntries || (bytes_ > kMaxBytes && entries_.size() > 1)) {
    bytes_ -= weight_of(entries_.front());
    entries_.pop_front();
  }
}

std::vector<LoggedMessage> MessageLog::since(std::uint64_t number) const {
  const std::scoped_lock lock(mutex_);
  const auto first = std::ranges::find_if(entries_, [&](const LoggedMessage& entry) { return entry.number > number; });
  return {first, entries_.end()};
}

std::uint64_t MessageLog::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

std::string message_text(const Message& message) {
  std::string text = printable(shortened(message.address, kMaxShownText));
  for (std::size_t i = 0; i < message.args.size() && i < kMaxShownArgs; i++) {
    const Arg& arg = message.args[i];
    switch (arg.kind) {
      case Arg::Kind::number:
        // five digits are enough to read
        text += fmt::format(" {:.5g}", arg.number);
        break;
      case Arg::Kind::boolean:
        text += arg.number != 0 ? " true" : " false";
        break;
      case Arg::Kind::nil:
        text += " nil";
        break;
      case Arg::Kind::text: {
        const std::string shown = printable(shortened(arg.text, kMaxShownText));
        const bool plain = !shown.empty() && shown.find_first_of(" \t\n\"") == std::string::npos;
        text += plain ? " " + shown : fmt::format(" \"{}\"", shown);
        break;
      }
    }
  }
  if (message.args.size() > kMaxShownArgs) text += fmt::format(" … ({} in all)", message.args.size());
  return text;
}

}  // namespace limber::engine
