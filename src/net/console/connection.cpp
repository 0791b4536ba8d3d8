// Buffering and request handling of one console connection.
#include "net/console/connection.h"

#include <cerrno>

#include "base/system/net/socket.h"

namespace limber::console {

namespace {

constexpr std::size_t kMaxUnreadOutput = 256 * 1024;  // bytes of unread output at which reading and sending pause
constexpr std::size_t kReadSize = 16384;              // bytes per read

}  // namespace

ConsoleConnection::ConsoleConnection(system::Descriptor connection, std::uint64_t seen)
    : connection_(std::move(connection)), seen_(seen) {}

bool ConsoleConnection::output_full() const { return output_.size() > kMaxUnreadOutput; }

void ConsoleConnection::append(std::string_view line) {
  if (!broken_) output_ += line;
}

// drops both buffers: the connection is broken
void ConsoleConnection::drop_connection() {
  broken_ = true;
  output_.clear();
  input_.clear();
}

system::PollEntry ConsoleConnection::poll_entry() const {
  if (broken_) return {};
  // stop reading while a request is pending or the output is not read: further input fills the kernel's buffer
  const bool read = !pending_ && !input_ended_ && !output_full();
  // a connection that only waits for its result is not polled, so that a hang-up does not wake the thread repeatedly
  return {.fd = read || !output_.empty() ? fd() : -1, .read = read, .write = !output_.empty()};
}

void ConsoleConnection::receive(const Submit& submit, const Subscribe& subscribe) {
  const bool has_line = input_.find('\n') != std::string::npos;
  if (!pending_ && !input_ended_ && !broken_ && !has_line && !output_full()) read_some();
  std::string line;
  while (!pending_ && !broken_ && !output_full() && next_line(line)) handle(line, submit, subscribe);
}

void ConsoleConnection::read_some() {
  char bytes[kReadSize];
  const std::ptrdiff_t got = system::receive_bytes(fd(), bytes, sizeof bytes);
  if (got > 0) {
    input_.append(bytes, static_cast<std::size_t>(got));
  } else if (got == 0) {
    input_ended_ = true;
  } else if (errno != EAGAIN && errno != EINTR) {
    drop_connection();
  }
}

// the next complete line; at the end of the input the rest counts as one
bool ConsoleConnection::next_line(std::string& line) {
  const std::size_t end = input_.find('\n');
  if (end == std::string::npos && input_.size() > kMaxLine) {
    append(rejected_line("a line can have at most 512 KiB"));
    input_.clear();
    input_ended_ = true;
    return false;
  }
  if (end == std::string::npos && (!input_ended_ || input_.empty())) return false;
  line = input_.substr(0, end);
  input_.erase(0, end == std::string::npos ? end : end + 1);
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

void ConsoleConnection::handle(const std::string& line, const Submit& submit, const Subscribe& subscribe) {
  if (line.empty()) return;
  Result<ConsoleRequest> request = parse_request(line);
  if (!request) {
    append(result_line(0, {Evaluation::Kind::error, request.error()}));
    return;
  }
  if (request->kind == ConsoleRequest::Kind::traffic || request->kind == ConsoleRequest::Kind::changes) {
    Result<std::unique_ptr<Subscription>> subscription = subscribe(*request);
    append(result_line(request->id,
                       subscription ? Evaluation{} : Evaluation{Evaluation::Kind::error, subscription.error()}));
    if (subscription) subscription_ = std::move(*subscription);
    return;
  }
  if (const std::string error = submit(*request); !error.empty()) {
    append(result_line(request->id, {Evaluation::Kind::error, error}));
    return;
  }
  pending_ = true;
}

void ConsoleConnection::finish_request(std::uint64_t id, const Evaluation& result) {
  pending_ = false;
  send_log_lines(result.log_before, 0);
  send_log_lines(result.log_after, id);
  append(result_line(id, result));
}

void ConsoleConnection::send_log() {
  if (!pending_) send_log_lines(log_newest(), 0);
}

void ConsoleConnection::send_log_lines(std::uint64_t up_to, std::uint64_t id) {
  if (up_to <= seen_) return;
  for (const LogLine& line : log_since(seen_)) {
    if (line.number > up_to) break;
    dropped_ += line.number - seen_ - 1;  // lines have been overwritten in the log's ring buffer
    seen_ = line.number;
    if (line.level == LogLevel::info) continue;
    append_or_drop(log_line(id, line));
  }
}

void ConsoleConnection::send_subscribed() {
  if (subscription_ == nullptr || broken_ || input_ended_) return;
  subscription_->poll([this](const std::string& line) { append_or_drop(line); },
                      [this](std::uint64_t count) { dropped_ += count; });
}

// counts dropped lines while the console does not read, and reports the count before the next line
void ConsoleConnection::append_or_drop(std::string_view line) {
  if (output_full()) return (void)dropped_++;
  if (dropped_ > 0) append(missed_line(std::exchange(dropped_, 0)));
  append(line);
}

void ConsoleConnection::send() {
  while (!output_.empty() && !broken_) {
    const std::ptrdiff_t sent = system::send_bytes(fd(), output_);
    if (sent > 0) {
      output_.erase(0, static_cast<std::size_t>(sent));
    } else if (sent == 0 || errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      drop_connection();
    }
  }
}

}  // namespace limber::console
