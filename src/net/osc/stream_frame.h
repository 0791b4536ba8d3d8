// StreamFrame: all joint messages for one target, as complete datagrams in one buffer. Addresses, type tags, names and
// sizes are written once per body list; each frame overwrites only the numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/commands/command.h"
#include "engine/output/snapshot.h"

namespace limber::osc {

/// The datagrams of one frame of a stream. [net]
class StreamFrame {
 public:
  explicit StreamFrame(const engine::TransientOffsets& offsets) : offsets_(offsets) {}

  /// Rebuilds the layout if the body list or the configuration has changed since the last call. Messages are ordered by
  /// stream (pos, rot, relrot, relpos), then as in the body list; bodies without joints have none. A message larger
  /// than a datagram is omitted and its body listed in `too_large()`.
  void lay_out(const std::shared_ptr<const engine::BodyList>& body_list, const StreamTarget& config);
  /// Writes the snapshot's numbers into the messages. Does not allocate.
  void fill(const engine::Snapshot& snapshot);

  /// The sizes of the datagrams, which are stored contiguously in `bytes()`.
  std::span<const std::uint32_t> datagram_sizes() const { return datagrams_; }
  std::span<const char> bytes() const { return bytes_; }
  const std::vector<std::string>& too_large() const { return too_large_; }

 private:
  struct NumberBlock {
    std::uint32_t position = 0;  // offset in bytes_
    std::uint32_t body = 0;      // index in the body list
    std::uint32_t offset = 0;    // offset in a joint's block of Snapshot::transient
    std::uint32_t width = 0;     // numbers per joint
  };
  struct Stream {
    const char* address;
    std::uint32_t offset;
    std::uint32_t width;
  };

  void add_message(const Stream& stream, const engine::BodyEntry& body, std::uint32_t index, std::size_t limit);
  void end_datagram();

  const engine::TransientOffsets offsets_;
  std::shared_ptr<const engine::BodyList> body_list_;
  StreamTarget config_;
  std::vector<char> bytes_;
  std::vector<std::uint32_t> datagrams_;
  std::vector<NumberBlock> numbers_;
  std::vector<std::string> too_large_;
  std::vector<std::uint32_t> open_;  // sizes of the messages since the last datagram
  std::size_t begin_ = 0;            // offset of the open datagram in bytes_
  std::size_t first_numbers_ = 0;    // index of its first entry in numbers_
};

}  // namespace limber::osc
