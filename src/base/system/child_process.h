// ChildProcess: a program that this one starts and writes to. [one thread]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/system/descriptor.h"

namespace limber::system {

class ChildProcess {
 public:
  ChildProcess() = default;
  /// Kills a process that was not waited for.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Starts the program words[0], which is looked for in PATH, with these arguments, standard input from write(), and
  /// in a process group of its own: Ctrl+C reaches only this program. 0, or the error's number.
  int start(const std::vector<std::string>& words);
  bool started() const { return pid_ >= 0; }
  /// False: it reads no more.
  bool write(std::string_view bytes);
  /// Closes its input and waits for its end; whether it ended with exit code 0.
  bool finish();
  /// Ends it at once and waits for that.
  void kill();

 private:
  int pid_ = -1;
  Descriptor input_;
};

}  // namespace limber::system
