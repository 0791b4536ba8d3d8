// Binary encoding of takes: variable-length integers; messages refer to the headers of earlier messages. The codec is
// stateful: a stream must be decoded from its start, in the order in which it was encoded. [one thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.h"
#include "engine/takes/take.h"

namespace limber::engine {

/// Encodes values at the end of a string. Doesn't allocate while the capacity of the string suffices.
class TakeEncoder {
 public:
  explicit TakeEncoder(std::string& out) : out_(out) {}
  void byte(std::uint8_t value) { out_.push_back(static_cast<char>(value)); }
  void varint(std::uint64_t value);                ///< Variable length, 7 bits per byte.
  void fixed_int(std::uint64_t value, int bytes);  ///< Fixed length, little-endian.
  void real(double value);
  void string(std::string_view value);  ///< Length, then the bytes.

 private:
  std::string& out_;
};

/// Decodes the output of TakeEncoder. After the end of the data all values are 0 or empty, and failed() is true.
class TakeDecoder {
 public:
  explicit TakeDecoder(std::string_view bytes) : bytes_(bytes) {}
  std::uint8_t byte();
  std::uint64_t varint();
  std::uint64_t fixed_int(int bytes);
  double real();
  std::string_view string();
  /// Reads the number of elements of a list, each of at least one byte; fails if the rest of the data is too short.
  std::size_t count();
  bool failed() const { return failed_; }
  void fail() { failed_ = true; }
  bool at_end() const { return bytes_.empty() && !failed_; }

 private:
  std::string_view read_bytes(std::size_t bytes);
  std::string_view bytes_;
  bool failed_ = false;
};

/// Encodes messages. The header (address, sender, types of arguments) is written once; later messages refer to it.
class InputCodec {
 public:
  /// Bounds the memory when each message has another header. With 0 each message has its header, so that the codec is
  /// stateless: decoding may begin with any message.
  static constexpr std::size_t kMaxHeaders = 65536;
  explicit InputCodec(std::size_t max_headers = kMaxHeaders) : max_headers_(max_headers) {}

  void encode(TakeEncoder& out, const Message& message, const CommandOrigin& origin);
  bool decode(TakeDecoder& in, InputRecord& message);

 private:
  std::size_t max_headers_;
  std::unordered_map<std::string, std::uint32_t> header_numbers_;  // encoder
  struct Header {
    CommandOrigin origin;
    std::string types, address;
  };
  static std::optional<Header> parse_header(std::string_view key);
  std::vector<Header> headers_;  // decoder
  std::string key_;              // scratch
};

/// Appends a frame: kind, length, payload, checksum.
void append_frame(std::string& out, TakeFrame kind, std::string_view payload);
std::uint32_t frame_checksum(TakeFrame kind, std::string_view payload);

/// Returns the two lines of the header.
std::string header_text(const TakeHeader& header);
Result<TakeHeader> header_of(std::string_view first_line, std::string_view second_line);

std::string text_of(const TakeInitialState& initial_state);
bool read_initial_state(std::string_view bytes, TakeInitialState& state);

/// Encodes the messages and console texts of a pass as they arrive, for takes and for the history. Doesn't allocate
/// once its buffers have grown.
class InputLog {
 public:
  explicit InputLog(std::size_t max_headers = InputCodec::kMaxHeaders) : codec_(max_headers) {}
  /// Records a message, or Lua code from a console (`evaluate`, in the address).
  void record(const Message& message, const CommandOrigin& origin, bool evaluate);
  bool empty() const { return count_ == 0; }
  void clear();
  /// Appends a pass to `out`, with the recorded messages instead of its own, and clears the log.
  void append_pass(std::string& out, const RecordedPass& pass);

 private:
  InputCodec codec_;
  std::string messages_;
  std::size_t count_ = 0;
  Message console_message_;  // scratch
};

/// True if simulated time advances in the tick that begins with this byte.
bool advances_time(std::uint8_t first_byte);
bool read_pass(std::string_view bytes, InputCodec& codec, RecordedPass& pass);

std::string text_of(const TakeEnd& end);
bool read_end(std::string_view bytes, TakeEnd& end);

/// Content of a `files` frame. Files refer to `content` frames by number.
struct TakeFileList {
  std::map<std::string, std::string> found;
  std::map<std::string, std::string> meshes;
  std::vector<std::pair<std::string, std::uint32_t>> files;  ///< Path and number of the content; 0: unreadable.
  bool has_presets = false;
  std::string preset_file;
  std::string presets;
  bool operator==(const TakeFileList&) const = default;
};
std::string text_of(const TakeFileList& list);
bool read_files(std::string_view bytes, TakeFileList& list);

}  // namespace limber::engine
