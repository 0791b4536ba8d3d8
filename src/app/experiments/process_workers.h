// ProcessWorkers: workers that are child processes of this program on this machine. A process simulates one evaluation
// after the other; it ends when its standard input is closed. [one thread]
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/system/child_process.h"
#include "experiments/dispatcher.h"

namespace limber::app {

class ProcessWorkers final : public experiments::Workers {
 public:
  /// `command`: the program and the arguments of a worker.
  ProcessWorkers(std::size_t count, std::vector<std::string> command);

  std::size_t count() const override { return workers_.size(); }
  Result<void> start(std::size_t worker) override;
  void send(std::size_t worker, std::string_view line) override;
  std::vector<Event> wait(std::chrono::microseconds limit) override;

 private:
  struct Worker {
    std::unique_ptr<system::ChildProcess> process;
    std::string received;  ///< The begin of a line.
  };
  void read(std::size_t index, std::vector<Event>& events);

  std::vector<std::string> command_;
  std::vector<Worker> workers_;
};

}  // namespace limber::app
