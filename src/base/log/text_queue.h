// TextQueue: a FIFO queue of texts with a fixed capacity in bytes and texts. It allocates at construction only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace limber {

/// A ring buffer of bytes and a ring buffer of entries. Not thread-safe.
class TextQueue {
 public:
  TextQueue(std::size_t bytes, std::size_t texts);

  /// True if there is space for a text of this size.
  bool fits(std::size_t size) const { return count_ < texts_ && used_ + size <= bytes_; }
  /// Appends a text, which must fit. `order` and `missing` are stored with it.
  void push(std::string_view text, std::uint64_t order, std::uint64_t missing);
  bool empty() const { return count_ == 0; }
  /// True if at most half of the bytes and half of the entries are in use.
  bool half_empty() const { return count_ * 2 <= texts_ && used_ * 2 <= bytes_; }
  std::uint64_t front_order() const { return entries_[first_].order; }
  /// Appends the oldest text to `to` and removes it. Returns its `missing`. The queue is not empty.
  std::uint64_t pop(std::string& to);

 private:
  struct Entry {
    std::uint64_t order = 0;
    std::uint64_t missing = 0;
    std::size_t size = 0;
  };

  std::size_t bytes_;
  std::size_t texts_;
  std::unique_ptr<char[]> block_;
  std::unique_ptr<Entry[]> entries_;
  std::size_t begin_ = 0;  // of the oldest text, in block_
  std::size_t used_ = 0;   // bytes
  std::size_t first_ = 0;  // the oldest text, in entries_
  std::size_t count_ = 0;  // texts
};

}  // namespace limber
