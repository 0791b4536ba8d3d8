// A stream frame: all of a target's joint messages as finished datagrams in one buffer. Addresses, tags, names and
// sizes are written once per roster; a frame overwrites the numbers only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/command.h"
#include "engine/snapshot.h"

namespace limber {

/// [net]
class StreamFrame {
 public:
  explicit StreamFrame(const LiveOffsets& offsets) : offsets_(offsets) {}

  /// Lays the frame out anew when the roster or the wish has changed since the last call. Messages stand by stream
  /// (pos, rot, relrot, relpos) and in it in the roster's order; bodies without joints have none. A message larger
  /// than a datagram is left out and its body named in `too_large()`.
  void lay_out(const std::shared_ptr<const Roster>& roster, const StreamTarget& wish);
  /// Writes the snapshot's numbers into the messages. No allocation.
  void fill(const Snapshot& snapshot);

  /// The datagrams, one behind the other in `bytes()`.
  std::span<const std::uint32_t> datagram_sizes() const { return datagrams_; }
  std::span<const char> bytes() const { return bytes_; }
  const std::vector<std::string>& too_large() const { return too_large_; }

 private:
  struct Numbers {
    std::uint32_t to = 0;      // where in bytes_
    std::uint32_t body = 0;    // which of the roster
    std::uint32_t offset = 0;  // in a joint's block of Snapshot::live
    std::uint32_t width = 0;   // numbers per joint
  };
  struct Stream {
    const char* address;
    std::uint32_t offset;
    std::uint32_t width;
  };

  void add_message(const Stream& stream, const RosterBody& body, std::uint32_t index, std::size_t limit);
  void end_datagram();

  const LiveOffsets offsets_;
  std::shared_ptr<const Roster> roster_;
  StreamTarget wish_;
  std::vector<char> bytes_;
  std::vector<std::uint32_t> datagrams_;
  std::vector<Numbers> numbers_;
  std::vector<std::string> too_large_;
  std::vector<std::uint32_t> open_;  // sizes of the messages since the last datagram
  std::size_t begin_ = 0;            // where in bytes_ the open datagram begins
  std::size_t first_numbers_ = 0;    // its first entry in numbers_
};

}  // namespace limber
