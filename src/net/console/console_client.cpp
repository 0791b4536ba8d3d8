// Connects to a program, sends requests and reads lines.
#include "net/console/console_client.h"

#include <cerrno>

#include <fmt/format.h>

#include "base/system/net/socket.h"
#include "base/system/wait.h"

namespace limber::console {

namespace {

constexpr int kHelloTimeoutMs = 2000;  // ms to wait for the first line of a program

std::string list_text(const std::vector<RunningProgram>& programs) {
  std::string text;
  for (const RunningProgram& each : programs)
    text += fmt::format("\n  limber console {}    {}", each.socket.pid, each.scene);
  return text;
}

// Returns false on timeout or after a signal. Unblocks signals while it waits, so that none is lost between two polls.
bool wait_readable(int fd, int wait_ms) {
  system::PollEntry waiting{.fd = fd};
  std::optional<std::chrono::nanoseconds> limit;
  if (wait_ms >= 0) limit = std::chrono::milliseconds(wait_ms);
  return system::wait_ready_or_signal({&waiting, 1}, limit);
}

// connects and reads the first line
Result<ConnectedProgram> connect_and_read_hello(const std::string& path) {
  Result<system::Descriptor> connection = connect_console(path);
  if (!connection) return Error{connection.error()};
  ConsoleClient client(std::move(*connection));
  std::optional<ConsoleLine> first = client.next(kHelloTimeoutMs);
  if (!first) return Error{fmt::format("{}: no answer", path)};
  if (first->kind == ConsoleLine::Kind::rejected) return Error{first->text};
  if (first->kind != ConsoleLine::Kind::hello) return Error{fmt::format("{}: not a Limber program", path)};
  return ConnectedProgram{std::move(client), std::move(*first)};
}

}  // namespace

bool ConsoleClient::send(const ConsoleRequest& request) {
  const std::string line = request_line(request);
  for (std::size_t sent = 0; sent < line.size();) {
    const std::ptrdiff_t n = system::send_bytes(fd(), std::string_view(line).substr(sent));
    if (n > 0) {
      sent += static_cast<std::size_t>(n);
    } else if (errno == EAGAIN) {
      system::PollEntry waiting{.fd = fd(), .read = false, .write = true};
      (void)system::wait_ready({&waiting, 1}, std::nullopt);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

std::optional<ConsoleLine> ConsoleClient::next_buffered_line() {
  while (true) {
    const std::size_t end = input_.find('\n');
    if (end == std::string::npos) return {};
    Result<ConsoleLine> line = parse_line(std::string_view(input_).substr(0, end));
    input_.erase(0, end + 1);
    // skip lines of newer programs that this version does not know
    if (line) return std::move(*line);
  }
}

// false: nothing to read at the moment
bool ConsoleClient::read_some() {
  char bytes[16384];
  const std::ptrdiff_t got = system::receive_bytes(fd(), bytes, sizeof bytes);
  if (got > 0) {
    input_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }
  if (got == 0 || (errno != EAGAIN && errno != EINTR)) ended_ = true;
  return false;
}

std::optional<ConsoleLine> ConsoleClient::next(int wait_ms) {
  while (true) {
    if (std::optional<ConsoleLine> line = next_buffered_line()) return line;
    if (ended_) return {};
    if (read_some()) continue;
    if (ended_) return {};
    if (!wait_readable(fd(), wait_ms)) return {};
  }
}

std::vector<RunningProgram> running_programs() {
  std::vector<RunningProgram> programs;
  for (const std::string& folder : runtime_folders()) {
    for (ConsoleSocket& socket : console_sockets(folder)) {
      const Result<ConnectedProgram> program = connect_and_read_hello(socket.path);
      programs.push_back({std::move(socket), program ? program->hello.text : program.error()});
    }
  }
  return programs;
}

Result<ConnectedProgram> connect_to_program(int pid) {
  std::vector<RunningProgram> programs = running_programs();
  if (programs.empty()) {
    return Error{"no Limber program of this user is running; start one with `limber play`, without --fast"};
  }
  if (pid == 0 && programs.size() > 1)
    return Error{fmt::format("{} of your programs are running; choose one:{}", programs.size(), list_text(programs))};
  for (const RunningProgram& each : programs) {
    if (pid == 0 || each.socket.pid == pid) return connect_and_read_hello(each.socket.path);
  }
  return Error{fmt::format("no running Limber program has the process id {}; there are:{}", pid, list_text(programs))};
}

}  // namespace limber::console
