// Child processes, and the lines that they write to their standard output.
#include "app/experiments/process_workers.h"

#include <array>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr std::size_t kMaxLine = std::size_t{1} << 24;

}  // namespace

ProcessWorkers::ProcessWorkers(std::size_t count, std::vector<std::string> command) : command_(std::move(command)) {
  workers_.resize(count);
}

Result<void> ProcessWorkers::start(std::size_t worker) {
  Worker& state = workers_[worker];
  state.received.clear();
  state.process = std::make_unique<system::ChildProcess>();  // kills the previous one
  const int fault = state.process->start_quietly(command_);
  if (fault == 0) return {};
  state.process.reset();
  return Error{
      fmt::format("{} can't be started: {}", printable(command_.front()), std::generic_category().message(fault))};
}

void ProcessWorkers::send(std::size_t worker, std::string_view line) {
  // if the process no longer reads, its output ends, which wait() reports
  if (workers_[worker].process != nullptr) (void)workers_[worker].process->write(fmt::format("{}\n", line));
}

std::vector<experiments::Workers::Event> ProcessWorkers::wait(std::chrono::microseconds limit) {
  std::vector<system::PollEntry> entries(workers_.size());
  for (std::size_t i = 0; i < workers_.size(); i++) {
    if (workers_[i].process != nullptr) entries[i].fd = workers_[i].process->output();
  }
  std::vector<Event> events;
  if (!system::wait_ready(entries, limit)) return events;
  for (std::size_t i = 0; i < workers_.size(); i++) {
    if (entries[i].ready) read(i, events);
  }
  return events;
}

void ProcessWorkers::read(std::size_t index, std::vector<Event>& events) {
  Worker& worker = workers_[index];
  std::array<char, 1 << 16> buffer;
  const std::ptrdiff_t size = system::read_some(worker.process->output(), buffer.data(), buffer.size());
  if (size <= 0 || worker.received.size() > kMaxLine) {
    worker.process.reset();
    events.push_back({index, {}});
    return;
  }
  worker.received.append(buffer.data(), static_cast<std::size_t>(size));
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = worker.received.find('\n', begin)) != std::string::npos; begin = end + 1)
    events.push_back({index, worker.received.substr(begin, end - begin)});
  worker.received.erase(0, begin);
}

}  // namespace limber::app
