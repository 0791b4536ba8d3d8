// A ring of lines under a lock that is held for a copy.
#include "engine/traffic.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/system/clock.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kShownArgs = 16;
constexpr std::size_t kShownText = 200;

std::size_t weight_of(const TrafficLine& line) {
  std::size_t bytes = sizeof line + line.end.size() + line.message.address.size();
  for (const Arg& arg : line.message.args) bytes += sizeof arg + arg.text.size();
  return bytes;
}

}  // namespace

void Traffic::note(bool in, std::string end, const Message& message) {
  TrafficLine line{0, system::clock_seconds(), in, std::move(end), message};
  const std::size_t bytes = weight_of(line);
  const std::scoped_lock lock(mutex_);
  line.number = ++newest_;
  bytes_ += bytes;
  lines_.push_back(std::move(line));
  while (lines_.size() > kMostLines || (bytes_ > kMostBytes && lines_.size() > 1)) {
    bytes_ -= weight_of(lines_.front());
    lines_.pop_front();
  }
}

std::vector<TrafficLine> Traffic::since(std::uint64_t number) const {
  const std::scoped_lock lock(mutex_);
  const auto first = std::ranges::find_if(lines_, [&](const TrafficLine& line) { return line.number > number; });
  return {first, lines_.end()};
}

std::uint64_t Traffic::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

std::string message_text(const Message& message) {
  std::string text = printable(shortened(message.address, kShownText));
  for (std::size_t i = 0; i < message.args.size() && i < kShownArgs; i++) {
    const Arg& arg = message.args[i];
    switch (arg.kind) {
      case Arg::Kind::number:
        // five digits are what a person reads
        text += fmt::format(" {:.5g}", arg.number);
        break;
      case Arg::Kind::boolean:
        text += arg.number != 0 ? " true" : " false";
        break;
      case Arg::Kind::nil:
        text += " nil";
        break;
      case Arg::Kind::text: {
        const std::string shown = printable(shortened(arg.text, kShownText));
        const bool plain = !shown.empty() && shown.find_first_of(" \t\n\"") == std::string::npos;
        text += plain ? " " + shown : fmt::format(" \"{}\"", shown);
        break;
      }
    }
  }
  if (message.args.size() > kShownArgs) text += fmt::format(" … ({} in all)", message.args.size());
  return text;
}

}  // namespace limber
