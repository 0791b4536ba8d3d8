// TakeReader: takes a file of a take apart, from its first byte to its last whole frame. [one thread]
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/take_text.h"

namespace limber {

class TakeReader {
 public:
  /// The error names the file. `name`: how it is called.
  static Result<std::unique_ptr<TakeReader>> open(const std::string& path);
  static Result<std::unique_ptr<TakeReader>> of(std::unique_ptr<std::istream> in, const std::string& name);

  const TakeHeader& header() const { return header_; }
  const TakeBegin& begin() const { return begin_; }
  /// The next tick takes the place of `tick`, and its memory; false from where the take ends.
  bool next(TakeTick& tick);
  /// Of the ticks that are left, those in which time goes on; it is at the end then. Reads frames' heads alone.
  std::uint64_t count_ticks();
  /// Once next() gave nothing: how it was ended; nothing, where it was cut off.
  const std::optional<TakeEnd>& end() const { return end_; }
  /// What is wrong behind the last whole frame, if something is.
  const std::string& damage() const { return damage_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }

  /// What a run read, for that number; known once a tick that names it was read. Null where there is none.
  std::shared_ptr<const Sources> sources(std::uint32_t files);
  struct PresetBook {
    PresetList list;
    std::string file;
  };
  std::optional<PresetBook> presets(std::uint32_t files) const;
  const std::vector<TakeFileList>& file_lists() const { return lists_; }
  /// Bytes of a content, by its number.
  std::size_t content_size(std::uint32_t content) const;

 private:
  explicit TakeReader(std::string name) : name_(std::move(name)) {}
  Result<void> read_head();
  struct FrameHead {
    int kind = 0;
    std::uint64_t length = 0;  // of the payload
    std::uint64_t bytes = 0;   // of the head itself
  };
  /// Nothing at the end, and where no whole frame is left.
  std::optional<FrameHead> frame_head();
  /// The next frame's kind; nothing at the end, and where no whole frame is left.
  std::optional<TakeFrame> frame();
  bool bytes(std::size_t count, std::string& out);
  bool take_frame(TakeFrame kind, TakeTick& tick);
  void damaged(const std::string& what);

  std::string name_;
  std::unique_ptr<std::istream> in_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;  // behind the last whole frame
  std::string payload_;
  TakeHeader header_;
  TakeBegin begin_;
  TakeForms forms_;
  std::vector<std::shared_ptr<const std::string>> contents_;
  std::vector<TakeFileList> lists_;
  std::vector<std::shared_ptr<const Sources>> sources_;
  std::map<std::string, std::shared_ptr<ModelLibrary>> libraries_;  // by all that is in models and meshes
  bool over_ = false;                                               // next() has come to the end, whichever
  std::optional<TakeEnd> end_;
  std::string damage_;
};

}  // namespace limber
