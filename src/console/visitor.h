// Visitor: one console that is connected. Bounded: one request at a time, a line's length, and what waits to be read.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/system/descriptor.h"
#include "base/system/wait.h"
#include "console/protocol.h"
#include "console/watcher.h"

namespace limber {

/// [the server's thread]
class Visitor {
 public:
  /// Hands a request on; the answer comes later by answer(). The text of why it can't be, or nothing.
  using Ask = std::function<std::string(const ConsoleRequest&)>;
  /// Makes what tells of what is watched.
  using Watch = std::function<Result<std::unique_ptr<Watcher>>(const ConsoleRequest&)>;

  /// Lines of the log after `seen` are told.
  Visitor(system::Descriptor connection, std::uint64_t seen);

  int fd() const { return connection_.fd(); }
  /// The descriptor that the server waits for, and until when.
  system::Waiting waits_for() const;
  /// Says a line as it is.
  void say(std::string_view line);
  /// Reads some of what has come, and asks for the next request unless one is under way.
  void receive(const Ask& ask, const Watch& watch);
  void answer(std::uint64_t id, const Evaluation& said);
  /// What the log has for it; while a request is under way it waits, so that what the request printed can be told
  /// apart.
  void tell_log();
  /// What is new of what it watches.
  void tell_watched();
  /// Writes what the other end takes.
  void send();
  /// Nothing more can come of it. One that left while its request is under way stays until that is answered: so what is
  /// under way is bounded by how many are let in.
  bool gone() const { return !busy_ && (gone_ || (ends_ && out_.empty())); }

 private:
  void read_some();
  bool next_line(std::string& line);
  void handle(const std::string& line, const Ask& ask, const Watch& watch);
  void say_or_miss(std::string_view line);
  void leave();
  void tell_lines(std::uint64_t up_to, std::uint64_t id);
  bool waits_to_be_read() const;

  system::Descriptor connection_;
  std::string in_;
  std::string out_;
  std::uint64_t seen_;
  std::uint64_t missed_ = 0;
  std::unique_ptr<Watcher> watcher_;
  bool busy_ = false;  // a request is under way
  bool ends_ = false;  // the other end says no more
  bool gone_ = false;
};

}  // namespace limber
