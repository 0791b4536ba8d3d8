// Ring buffers: a text that reaches the end of the block continues at its beginning.
#include "base/log/text_queue.h"

#include <algorithm>
#include <cstring>

namespace limber {

TextQueue::TextQueue(std::size_t bytes, std::size_t texts)
    : bytes_(bytes),
      texts_(texts),
      block_(std::make_unique_for_overwrite<char[]>(bytes)),
      entries_(std::make_unique_for_overwrite<Entry[]>(texts)) {}

void TextQueue::push(std::string_view text, std::uint64_t order, std::uint64_t missing) {
  entries_[(first_ + count_) % texts_] = {order, missing, text.size()};
  count_++;
  const std::size_t at = (begin_ + used_) % bytes_;
  const std::size_t before_end = std::min(text.size(), bytes_ - at);
  std::memcpy(block_.get() + at, text.data(), before_end);
  std::memcpy(block_.get(), text.data() + before_end, text.size() - before_end);
  used_ += text.size();
}

std::uint64_t TextQueue::pop(std::string& to) {
  const Entry entry = entries_[first_];
  const std::size_t before_end = std::min(entry.size, bytes_ - begin_);
  to.append(block_.get() + begin_, before_end);
  to.append(block_.get(), entry.size - before_end);
  first_ = (first_ + 1) % texts_;
  count_--;
  begin_ = (begin_ + entry.size) % bytes_;
  used_ -= entry.size;
  return entry.missing;
}

}  // namespace limber
