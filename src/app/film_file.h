// FilmFile: where the frames of a film go: a video by ffmpeg, or one PNG file each.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/result.h"
#include "base/system/child_process.h"
#include "view/pixels.h"

namespace limber {

/// Whether a film of that size can be called so: a video's ending, or a pattern with one %d or %05d in it.
Result<void> check_film_file(const std::string& name, int width, int height);

class FilmFile {
 public:
  /// An error: there is no ffmpeg. [main]
  static Result<std::unique_ptr<FilmFile>> open(const std::string& name, int width, int height, double fps);
  /// Without finish() nothing of a video stays. [main]
  ~FilmFile();
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  Result<void> add(const Pixels& frame);
  /// What was added is whole now, under its name; nothing when no frame was. [main]
  Result<void> finish();

 private:
  explicit FilmFile(std::string name) : name_(std::move(name)) {}
  Result<void> start_ffmpeg(int width, int height, double fps);
  std::string still(std::uint64_t number) const;

  std::string name_;
  std::string beside_;  // a video while it is made
  std::uint64_t frames_ = 0;
  system::ChildProcess ffmpeg_;
};

}  // namespace limber
