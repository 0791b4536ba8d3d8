// LogSink: receives the log lines of a thread instead of the process's log, for programs that contain the simulation.
#pragma once

#include <string_view>

#include "base/log/log.h"

namespace limber {

class LogSink {
 public:
  virtual ~LogSink() = default;
  /// Receives a line, without control characters unless `level` is print. Must not throw.
  virtual void add(LogLevel level, std::string_view text) = 0;

  /// While an object of this class exists, all lines of this thread go to the sink: neither to the ring buffer nor to
  /// the outputs of the process, and without rate limits. Scopes nest.
  class Scope {
   public:
    explicit Scope(LogSink& sink);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    LogSink* previous_;
  };
};

}  // namespace limber
