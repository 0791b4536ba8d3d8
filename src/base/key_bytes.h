// KeyBytes: values one after the other in memory, to be brought back later. One function lists them for both ways, so
// that what is taken is what is brought back.
#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace limber {

class KeyBytes {
 public:
  /// From here on pass() takes values, over those of before.
  void begin_taking() {
    bytes_.clear();
    bringing_ = false;
  }
  /// From here on pass() brings back what `bytes` has, in the same order.
  void begin_bringing() {
    at_ = 0;
    bringing_ = true;
  }
  bool bringing() const { return bringing_; }
  /// How much was brought back.
  std::size_t at() const { return at_; }
  /// Only the first so many bytes stay; pass() takes values behind them.
  void go_on_taking(std::size_t size) {
    bytes_.resize(size);
    bringing_ = false;
  }
  /// Where all of it is; of that size before it is brought back.
  std::vector<std::byte>& bytes() { return bytes_; }

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void pass(T& value) { pass_raw(&value, sizeof value); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void pass(std::vector<T>& list) {
    std::size_t count = list.size();
    pass(count);
    if (bringing_) list.resize(count);
    pass_raw(list.data(), count * sizeof(T));
  }
  void pass(std::string& text) {
    std::size_t size = text.size();
    pass(size);
    if (bringing_) text.resize(size);
    pass_raw(text.data(), size);
  }
  template <class... T>
  void pass_all(T&... values) {
    (pass(values), ...);
  }

 private:
  void pass_raw(void* value, std::size_t size) {
    if (size == 0) return;
    if (bringing_) {
      std::memcpy(value, bytes_.data() + at_, size);
      at_ += size;
    } else {
      const auto* const from = static_cast<const std::byte*>(value);
      bytes_.insert(bytes_.end(), from, from + size);
    }
  }

  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
  bool bringing_ = false;
};

}  // namespace limber
