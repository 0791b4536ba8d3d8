// The bytes of a take: numbers as short as they can be, messages by the form that they share with earlier ones. What
// has been written or read so far is part of the meaning of what follows. [one thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "engine/take.h"

namespace limber {

/// Appends to a text. Nothing is allocated where the text has room.
class TakeBytes {
 public:
  explicit TakeBytes(std::string& out) : out_(out) {}
  void byte(std::uint8_t value) { out_.push_back(static_cast<char>(value)); }
  void number(std::uint64_t value);  ///< 7 bits a byte.
  void word(std::uint64_t value, int bytes);
  void real(double value);
  void text(std::string_view value);

 private:
  std::string& out_;
};

/// Takes apart what TakeBytes has put together; what is not there is 0, and `bad` from then on.
class TakeScan {
 public:
  explicit TakeScan(std::string_view bytes) : bytes_(bytes) {}
  std::uint8_t byte();
  std::uint64_t number();
  std::uint64_t word(int bytes);
  double real();
  std::string_view text();
  /// Of things that take a byte at least; bad where so many can't follow.
  std::size_t count();
  bool bad() const { return bad_; }
  void fail() { bad_ = true; }
  bool done() const { return bytes_.empty() && !bad_; }

 private:
  std::string_view take(std::size_t bytes);
  std::string_view bytes_;
  bool bad_ = false;
};

/// Messages: address, sender and types of arguments stand once, where they come first.
class TakeForms {
 public:
  void write(TakeBytes& out, const Message& message, const Origin& origin);
  bool read(TakeScan& in, TakeMessage& message);

 private:
  static constexpr std::size_t kMost = 65536;             // a flood of ever new ones ends here
  std::unordered_map<std::string, std::uint32_t> known_;  // when it is written
  struct Form {
    Origin origin;
    std::string types, address;
  };
  static std::optional<Form> form_of(std::string_view key);
  std::vector<Form> forms_;  // when it is read
  std::string key_;          // scratch
};

/// A frame: kind, length, payload, checksum.
void append_frame(std::string& out, TakeFrame kind, std::string_view payload);
std::uint32_t frame_check(TakeFrame kind, std::string_view payload);

std::string head_text(const TakeHeader& header);
Result<TakeHeader> header_of(std::string_view first_line, std::string_view second_line);

std::string text_of(const TakeBegin& begin);
bool read_begin(std::string_view bytes, TakeBegin& begin);

/// Everything of a tick but its messages, which are written as they come: `messages` are their bytes.
void append_tick(std::string& out, const TakeTick& tick, std::size_t message_count, std::string_view messages);
/// Whether time goes on in the tick that begins with this byte.
bool tick_runs(std::uint8_t first_byte);
bool read_tick(std::string_view bytes, TakeForms& forms, TakeTick& tick);

std::string text_of(const TakeEnd& end);
bool read_end(std::string_view bytes, TakeEnd& end);

/// As a `files` frame has it: contents by their numbers.
struct TakeFileList {
  std::map<std::string, std::string> found;
  std::map<std::string, std::string> meshes;
  std::vector<std::pair<std::string, std::uint32_t>> files;  ///< Path and content; 0: it could not be read.
  bool has_presets = false;
  std::string preset_file;
  std::string presets;
  bool operator==(const TakeFileList&) const = default;
};
std::string text_of(const TakeFileList& list);
bool read_files(std::string_view bytes, TakeFileList& list);

}  // namespace limber
