// TemplateFrame: the messages that a scene has described by templates (StreamMessage), for one target, as complete
// datagrams in one buffer. Addresses, type tags and texts are written once per structure of the tree; each frame
// overwrites only the numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/osc_config.h"
#include "engine/output/value_snapshot.h"

namespace limber::osc {

/// [net]
class TemplateFrame {
 public:
  /// Rebuilds the layout if the tree or the configuration has changed since the last call. Messages are in the order of
  /// the templates, then of the tree. A message that is larger than a datagram is omitted.
  void lay_out(const std::shared_ptr<const TreeSnapshot>& tree, const StreamTarget& config);
  /// Writes the snapshot's numbers into the messages. Does not allocate.
  void fill(const engine::ValueSnapshot& snapshot);

  /// The sizes of the datagrams, which are stored contiguously in `bytes()`.
  std::span<const std::uint32_t> datagram_sizes() const { return datagrams_; }
  std::span<const char> bytes() const { return bytes_; }
  /// Templates and objects that are omitted, with the reason, of the present layout.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct Number {
    std::uint32_t position = 0;  // in bytes_; while a message is built, in its own bytes
    ValueLocation location;
    std::uint32_t component = 0;
    float factor = 1;
  };
  struct Draft {
    std::string address, tags;
    std::string arguments;
    std::vector<Number> numbers;
  };

  Result<std::vector<std::uint32_t>> objects_of(const StreamMessage& wanted) const;
  void add_template(const StreamMessage& wanted);
  bool add_values(const StreamMessage& wanted, std::uint32_t node, std::size_t index, Draft& draft);
  bool add_value(const std::string& value, double scale, std::uint32_t node, Draft& draft);
  std::string expand(std::string_view text, std::uint32_t node, std::size_t index, bool escaped) const;
  std::uint32_t body_of(std::uint32_t node) const;
  void append(const Draft& draft);
  void end_datagram();
  void problem(std::string text);

  std::shared_ptr<const TreeSnapshot> tree_;
  StreamTarget config_;
  std::vector<char> bytes_;
  std::vector<std::uint32_t> datagrams_;
  std::vector<Number> numbers_;
  std::vector<std::string> problems_;
  std::size_t begin_ = 0;  // of the open datagram in bytes_
};

}  // namespace limber::osc
