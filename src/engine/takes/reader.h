// TakeReader: reads a take file from its start to its last complete frame. [one thread]
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/takes/encoding.h"

namespace limber::engine {

class TakeReader {
 public:
  /// Opens a take and reads its header and initial state. Errors begin with the path, or with `name` for a stream.
  static Result<std::unique_ptr<TakeReader>> open(const std::string& path);
  static Result<std::unique_ptr<TakeReader>> from_stream(std::unique_ptr<std::istream> in, const std::string& name);

  const TakeHeader& header() const { return header_; }
  const TakeInitialState& initial_state() const { return initial_state_; }
  /// Reads the next tick into `tick`, reusing its memory. False at the end of the take.
  bool next(RecordedPass& tick);
  /// Counts the remaining ticks in which simulated time advances, reading only the heads of frames. The reader is at
  /// the end afterwards.
  std::uint64_t count_ticks();
  /// The final state, after next() has returned false; nothing if the recording was interrupted.
  const std::optional<TakeEnd>& end() const { return end_; }
  /// Describes the corruption after the last complete frame; empty if there is none.
  const std::string& damage() const { return damage_; }
  /// Bytes up to the end of the last complete frame.
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }

  /// Returns the files of a run, by TakeSceneRun::files. Available once the tick with that run was read; null if there
  /// are none.
  std::shared_ptr<const script::Sources> sources(std::uint32_t files);
  /// Presets that a run has read, with the path of their file.
  struct PresetBank {
    PresetList list;
    std::string file;
  };
  std::optional<PresetBank> presets(std::uint32_t files) const;
  const std::vector<TakeFileList>& file_lists() const { return file_lists_; }
  /// Size in bytes of a `content` frame, by its number; 0 if there is none.
  std::size_t content_size(std::uint32_t content) const;

 private:
  explicit TakeReader(std::string name) : name_(std::move(name)) {}
  Result<void> read_head();
  struct FrameHead {
    int kind = 0;
    std::uint64_t length = 0;  // of the payload
    std::uint64_t bytes = 0;   // of the head: kind and length
  };
  /// Reads the head of the next frame; nothing at the end, and if no complete frame is left.
  std::optional<FrameHead> frame_head();
  /// Reads the next frame into payload_ and returns its kind; nothing at the end, and if no complete frame is left.
  std::optional<TakeFrame> frame();
  bool read_bytes(std::size_t count, std::string& out);
  /// Decodes the payload. False if it is invalid.
  bool decode_frame(TakeFrame kind, RecordedPass& tick);
  void set_damage(const std::string& description);

  std::string name_;
  std::unique_ptr<std::istream> in_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;  // end of the last complete frame
  std::string payload_;
  TakeHeader header_;
  TakeInitialState initial_state_;
  InputCodec codec_;
  std::vector<std::shared_ptr<const std::string>> contents_;
  std::vector<TakeFileList> file_lists_;
  std::vector<std::shared_ptr<const script::Sources>> sources_;
  std::map<std::string, std::shared_ptr<model::ModelLibrary>> libraries_;  // by the list of their models and meshes
  bool at_end_ = false;  // next() has reached the end, or a corrupt frame
  std::optional<TakeEnd> end_;
  std::string damage_;
};

}  // namespace limber::engine
