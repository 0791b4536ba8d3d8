// ChildProcess: starts a program, writes to its standard input, and may read its standard output. [one thread]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/system/descriptor.h"

namespace limber::system {

class ChildProcess {
 public:
  ChildProcess() = default;
  /// Kills the process if finish() was not called.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Starts the program words[0], which is searched in PATH, with these arguments and a pipe from write() as standard
  /// input. It gets its own process group, so that Ctrl+C does not reach it. Returns 0 or an errno.
  int start(const std::vector<std::string>& words) { return start(words, false); }
  /// Like start(), with a pipe from its standard output to output(); its standard error is discarded.
  int start_quietly(const std::vector<std::string>& words) { return start(words, true); }
  bool started() const { return pid_ >= 0; }
  /// The descriptor of its standard output after start_quietly(), else -1.
  int output() const { return output_.fd(); }
  /// Writes all bytes. False if the process no longer reads.
  bool write(std::string_view bytes);
  /// Closes its input and waits for its exit. True if the exit code is 0.
  bool finish();
  /// Kills it and waits for its exit.
  void kill();

 private:
  int start(const std::vector<std::string>& words, bool quietly);

  int pid_ = -1;
  Descriptor input_;
  Descriptor output_;
};

}  // namespace limber::system
