// An element's size is written when the element ends.
#include "net/osc/packets/packet_writer.h"

#include <bit>
#include <cstring>

#include "net/osc/packets/wire.h"

namespace limber::osc {

char* PacketWriter::extend(std::size_t bytes) {
  if (!valid_ || bytes > size_ - used_) {
    valid_ = false;
    return nullptr;
  }
  char* const at = begin_ + used_;
  used_ += bytes;
  return at;
}

bool PacketWriter::begin_element() {
  // a packet has exactly one outermost element
  valid_ = valid_ && !message_open_ && open_ < elements_.size() && (open_ > 0 || used_ == 0);
  if (open_ > 0 && extend(4) == nullptr) return false;
  if (!valid_) return false;
  elements_[open_++] = used_;
  return true;
}

void PacketWriter::end_element() {
  const std::size_t begin = elements_[--open_];
  if (open_ > 0) store_u32(begin_ + begin - 4, static_cast<std::uint32_t>(used_ - begin));
}

void PacketWriter::begin_bundle(std::uint64_t time_tag) {
  // reserve the deepest level for messages
  valid_ = valid_ && open_ + 1 < elements_.size();
  if (!begin_element()) return;
  char* const at = extend(kBundleHeader);
  if (at == nullptr) return;
  std::memcpy(at, "#bundle", 8);
  store_u64(at + 8, time_tag);
}

void PacketWriter::end_bundle() {
  valid_ = valid_ && !message_open_ && open_ > 0;
  if (valid_) end_element();
}

void PacketWriter::begin_message(std::string_view address, std::size_t tags) {
  if (!begin_element()) return;
  const std::size_t text = padded(address.size());
  char* const at = extend(text + padded(1 + tags));
  if (at == nullptr) return;
  std::memset(at + text - 4, 0, 4 + padded(1 + tags));
  address.copy(at, address.size());
  at[text] = ',';
  tag_ = used_ - padded(1 + tags) + 1;
  tags_left_ = tags;
  message_open_ = true;
}

void PacketWriter::end_message() {
  valid_ = valid_ && message_open_ && tags_left_ == 0;
  if (!valid_) return;
  message_open_ = false;
  end_element();
}

char* PacketWriter::argument(char tag, std::size_t bytes) {
  valid_ = valid_ && message_open_ && tags_left_ > 0;
  char* const at = extend(bytes);
  if (at == nullptr) return nullptr;
  begin_[tag_++] = tag;
  tags_left_--;
  return at;
}

void PacketWriter::write_u32(char tag, std::uint32_t value) {
  if (char* const at = argument(tag, 4)) store_u32(at, value);
}

void PacketWriter::write_u64(char tag, std::uint64_t value) {
  if (char* const at = argument(tag, 8)) store_u64(at, value);
}

void PacketWriter::float32(float value) { write_u32('f', std::bit_cast<std::uint32_t>(value)); }
void PacketWriter::float64(double value) { write_u64('d', std::bit_cast<std::uint64_t>(value)); }

void PacketWriter::padded_text(char tag, std::string_view text) {
  const std::size_t size = padded(text.size());
  char* const at = argument(tag, size);
  if (at == nullptr) return;
  std::memset(at + size - 4, 0, 4);
  text.copy(at, text.size());
}

void PacketWriter::blob(std::string_view bytes) {
  const std::size_t size = (bytes.size() + 3) / 4 * 4;
  char* const at = argument('b', 4 + size);
  if (at == nullptr) return;
  store_u32(at, static_cast<std::uint32_t>(bytes.size()));
  if (bytes.empty()) return;
  std::memset(at + size, 0, 4);
  bytes.copy(at + 4, bytes.size());
}

std::span<const char> PacketWriter::packet() const {
  if (!valid_ || open_ > 0) return {};
  return {begin_, used_};
}

}  // namespace limber::osc
