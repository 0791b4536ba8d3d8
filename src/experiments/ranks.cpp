// The protocol between rank 0 and the others.
#include "experiments/ranks.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::experiments {

namespace {

using std::chrono::microseconds;

// MPI has no wait that leaves the processor to others, so ranks ask for messages at these intervals.
constexpr microseconds kMasterInterval{300};
constexpr microseconds kIdleInterval{200};  // soon after an answer, as the next evaluation is on its way
constexpr microseconds kLongIdleInterval{2000};
constexpr microseconds kBusyInterval{20000};  // an answer of the worker ends this wait
constexpr int kIdleSteps = 500;
constexpr std::array kKinds{'h', 's', 'l', 'e', 'q'};  // in the order of RankMessage::Kind

}  // namespace

std::string RankMessage::encode() const {
  return fmt::format("{}{}\n{}", kKinds[static_cast<std::size_t>(kind)], start, text);
}

std::optional<RankMessage> RankMessage::decode(std::string_view bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos || end < 2) return {};
  const auto kind = std::ranges::find(kKinds, bytes.front());
  if (kind == kKinds.end() || (bytes[1] == '0' && end > 2)) return {};
  RankMessage message;
  message.kind = static_cast<Kind>(kind - kKinds.begin());
  const auto [rest, fault] = std::from_chars(bytes.data() + 1, bytes.data() + end, message.start);
  if (fault != std::errc() || rest != bytes.data() + end) return {};
  message.text = bytes.substr(end + 1);
  return message;
}

RankWorkers::RankWorkers(RankMessages& messages, Workers& local, std::string program)
    : messages_(messages), local_(local), program_(std::move(program)), ranks_(messages.size()) {}

RankWorkers::~RankWorkers() {
  for (std::size_t i = 1; i < ranks_.size(); i++)
    messages_.send(i, RankMessage{RankMessage::Kind::quit, ranks_[i].start, {}}.encode());
}

std::string RankWorkers::place(std::size_t worker) const {
  if (worker == 0) return {};
  const std::string& host = ranks_[worker].host;
  return host.empty() ? fmt::format("rank {}", worker) : fmt::format("rank {} on {}", worker, printable(host));
}

Result<void> RankWorkers::start(std::size_t worker) {
  if (worker == 0) return local_.start(0);
  ranks_[worker].start++;
  messages_.send(worker, RankMessage{RankMessage::Kind::start, ranks_[worker].start, {}}.encode());
  return {};
}

void RankWorkers::send(std::size_t worker, std::string_view line) {
  if (worker == 0) return local_.send(0, line);
  messages_.send(worker, RankMessage{RankMessage::Kind::line, ranks_[worker].start, std::string(line)}.encode());
}

std::vector<Workers::Event> RankWorkers::wait(microseconds limit) {
  std::vector<Event> events;
  receive(events);
  if (!events.empty()) limit = {};
  do {
    for (Event& event : local_.wait(std::min(limit, kMasterInterval))) events.push_back(std::move(event));
    receive(events);
    limit -= kMasterInterval;
  } while (events.empty() && limit.count() > 0);
  return events;
}

void RankWorkers::receive(std::vector<Event>& events) {
  while (const std::optional<RankMessages::Message> message = messages_.receive()) handle(*message, events);
}

void RankWorkers::handle(const RankMessages::Message& message, std::vector<Event>& events) {
  if (message.from == 0 || message.from >= ranks_.size()) return;
  Rank& rank = ranks_[message.from];
  std::optional<RankMessage> decoded = RankMessage::decode(message.bytes);
  if (decoded && decoded->kind == RankMessage::Kind::hello) {
    const std::size_t end = decoded->text.find('\n');
    const std::string program = decoded->text.substr(0, end);
    if (end != std::string::npos)
      rank.host = decoded->text.substr(end + 1, decoded->text.find('\n', end + 1) - end - 1);
    if (program == program_) return;
    const WorkerFault fault{fmt::format("its limber is {}, that of rank 0 is {}; install the same one on all nodes",
                                        printable(program), program_)};
    return events.push_back({message.from, encode(Answer(fault))});
  }
  // of a worker that was replaced
  if (decoded && decoded->start != rank.start) return;
  if (decoded && decoded->kind == RankMessage::Kind::line)
    events.push_back({message.from, std::move(decoded->text)});
  else
    events.push_back({message.from, {}});
}

RankWorker::RankWorker(RankMessages& messages, Workers& local, const std::string& program, const std::string& host)
    : messages_(messages), local_(local) {
  send(RankMessage::Kind::hello, program + "\n" + host);
}

void RankWorker::send(RankMessage::Kind kind, std::string text) {
  messages_.send(0, RankMessage{kind, start_, std::move(text)}.encode());
}

bool RankWorker::handle(const RankMessage& message) {
  if (message.kind == RankMessage::Kind::quit) return false;
  if (message.kind == RankMessage::Kind::start) {
    start_ = message.start;
    if (const Result<void> started = local_.start(0); !started)
      send(RankMessage::Kind::line, encode(Answer(WorkerFault{started.error()})));
  } else if (message.kind == RankMessage::Kind::line && message.start == start_) {
    local_.send(0, message.text);
    busy_ = true;
  }
  return true;
}

bool RankWorker::step() {
  while (const std::optional<RankMessages::Message> received = messages_.receive()) {
    idle_steps_ = 0;
    const std::optional<RankMessage> message = RankMessage::decode(received->bytes);
    if (message && !handle(*message)) return false;
  }
  const microseconds idle = idle_steps_ < kIdleSteps ? kIdleInterval : kLongIdleInterval;
  const std::vector<Workers::Event> events = local_.wait(busy_ ? kBusyInterval : idle);
  if (busy_ || !events.empty()) {
    idle_steps_ = 0;
  } else if (idle_steps_ < kIdleSteps) {
    idle_steps_++;
  }
  for (const Workers::Event& event : events) {
    busy_ = false;
    send(event.line ? RankMessage::Kind::line : RankMessage::Kind::ended, event.line.value_or(""));
  }
  return true;
}

}  // namespace limber::experiments
