// One connection's buffers.
#include "console/visitor.h"

#include <cerrno>

#include "base/system/socket.h"

namespace limber {

namespace {

constexpr std::size_t kMostWaiting = 256 * 1024;  // bytes that wait to be read before nothing more is said or asked
constexpr std::size_t kSlice = 16384;             // bytes read at a time

}  // namespace

Visitor::Visitor(system::Descriptor connection, std::uint64_t seen) : connection_(std::move(connection)), seen_(seen) {}

bool Visitor::waits_to_be_read() const { return out_.size() > kMostWaiting; }

void Visitor::say(std::string_view line) {
  if (!gone_) out_ += line;
}

// the other end is not there any more
void Visitor::leave() {
  gone_ = true;
  out_.clear();
  in_.clear();
}

system::Waiting Visitor::waits_for() const {
  if (gone_) return {};
  // one that is busy or does not read must wait; what it sends fills the kernel's buffer and then its own
  const bool read = !busy_ && !ends_ && !waits_to_be_read();
  // one that waits for its answer is left out, so that it does not wake us by hanging up
  return {.fd = read || !out_.empty() ? fd() : -1, .read = read, .write = !out_.empty()};
}

void Visitor::receive(const Ask& ask, const Watch& watch) {
  const bool has_line = in_.find('\n') != std::string::npos;
  if (!busy_ && !ends_ && !gone_ && !has_line && !waits_to_be_read()) read_some();
  std::string line;
  while (!busy_ && !gone_ && !waits_to_be_read() && next_line(line)) handle(line, ask, watch);
}

void Visitor::read_some() {
  char bytes[kSlice];
  const std::ptrdiff_t got = system::receive_bytes(fd(), bytes, sizeof bytes);
  if (got > 0) {
    in_.append(bytes, static_cast<std::size_t>(got));
  } else if (got == 0) {
    ends_ = true;
  } else if (errno != EAGAIN && errno != EINTR) {
    leave();
  }
}

// the next whole line; at the end what is left counts as one
bool Visitor::next_line(std::string& line) {
  const std::size_t end = in_.find('\n');
  if (end == std::string::npos && in_.size() > kMostLine) {
    say(refused_line("a line may have 512 KiB"));
    in_.clear();
    ends_ = true;
    return false;
  }
  if (end == std::string::npos && (!ends_ || in_.empty())) return false;
  line = in_.substr(0, end);
  in_.erase(0, end == std::string::npos ? end : end + 1);
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

void Visitor::handle(const std::string& line, const Ask& ask, const Watch& watch) {
  if (line.empty()) return;
  Result<ConsoleRequest> request = parse_request(line);
  if (!request) {
    say(answer_line(0, {Evaluation::Kind::error, request.error()}));
    return;
  }
  if (request->wish == ConsoleRequest::Wish::traffic || request->wish == ConsoleRequest::Wish::changes) {
    Result<std::unique_ptr<Watcher>> watcher = watch(*request);
    say(answer_line(request->id, watcher ? Evaluation{} : Evaluation{Evaluation::Kind::error, watcher.error()}));
    if (watcher) watcher_ = std::move(*watcher);
    return;
  }
  if (const std::string fault = ask(*request); !fault.empty()) {
    say(answer_line(request->id, {Evaluation::Kind::error, fault}));
    return;
  }
  busy_ = true;
}

void Visitor::answer(std::uint64_t id, const Evaluation& said) {
  busy_ = false;
  tell_lines(said.log_before, 0);
  tell_lines(said.log_after, id);
  say(answer_line(id, said));
}

void Visitor::tell_log() {
  if (!busy_) tell_lines(log_newest(), 0);
}

void Visitor::tell_lines(std::uint64_t up_to, std::uint64_t id) {
  if (up_to <= seen_) return;
  for (const LogLine& line : log_since(seen_)) {
    if (line.number > up_to) break;
    missed_ += line.number - seen_ - 1;  // the ring has gone round
    seen_ = line.number;
    if (line.level == LogLevel::info) continue;
    say_or_miss(log_line(id, line));
  }
}

void Visitor::tell_watched() {
  if (watcher_ == nullptr || gone_ || ends_) return;
  watcher_->tell([this](const std::string& line) { say_or_miss(line); },
                 [this](std::uint64_t count) { missed_ += count; });
}

// one that does not read what it is told hears how much that was
void Visitor::say_or_miss(std::string_view line) {
  if (waits_to_be_read()) return (void)missed_++;
  if (missed_ > 0) say(missed_line(std::exchange(missed_, 0)));
  say(line);
}

void Visitor::send() {
  while (!out_.empty() && !gone_) {
    const std::ptrdiff_t sent = system::send_bytes(fd(), out_);
    if (sent > 0) {
      out_.erase(0, static_cast<std::size_t>(sent));
    } else if (sent == 0 || errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      leave();
    }
  }
}

}  // namespace limber
