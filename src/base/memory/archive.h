// Archive: saves values to a byte buffer and loads them again. One serialize() function per type serves both
// directions, so that both have the same order. Loading does not check bounds: the bytes must come from the same
// functions of this program.
#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace limber {

class Archive;

/// A type with a function `void serialize(Archive&)` of its own.
template <class T>
concept HasSerialize = requires(T& value, Archive& archive) {
  value.serialize(archive);
};

class Archive {
 public:
  /// Starts saving: clears the buffer; serialize() appends to it.
  void begin_saving() {
    bytes_.clear();
    loading_ = false;
  }
  /// Starts loading: serialize() reads the values from the buffer in the same order.
  void begin_loading() {
    position_ = 0;
    loading_ = true;
  }
  bool loading() const { return loading_; }
  /// Number of bytes that were loaded.
  std::size_t position() const { return position_; }
  /// Truncates the buffer to `size` bytes and continues saving behind them.
  void resume_saving(std::size_t size) {
    bytes_.resize(size);
    loading_ = false;
  }
  /// The buffer. To load saved data, fill it before begin_loading().
  std::vector<std::byte>& bytes() { return bytes_; }

  /// A type is serialized by its own function, or else byte by byte.
  template <class T>
  requires HasSerialize<T> || std::is_trivially_copyable_v<T>
  void serialize(T& value) {
    if constexpr (HasSerialize<T>) {
      value.serialize(*this);
    } else {
      serialize_raw(&value, sizeof value);
    }
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void serialize(std::vector<T>& list) {
    std::size_t count = list.size();
    serialize(count);
    if (loading_) list.resize(count);
    serialize_raw(list.data(), count * sizeof(T));
  }
  void serialize(std::string& text) {
    std::size_t size = text.size();
    serialize(size);
    if (loading_) text.resize(size);
    serialize_raw(text.data(), size);
  }
  template <class... T>
  void serialize_all(T&... values) {
    (serialize(values), ...);
  }

 private:
  void serialize_raw(void* value, std::size_t size) {
    if (size == 0) return;
    if (loading_) {
      std::memcpy(value, bytes_.data() + position_, size);
      position_ += size;
    } else {
      const auto* const from = static_cast<const std::byte*>(value);
      bytes_.insert(bytes_.end(), from, from + size);
    }
  }

  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
  bool loading_ = false;
};

}  // namespace limber
