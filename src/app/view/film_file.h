// FilmFile: writes the frames of a film to a video (through ffmpeg) or to one PNG file per frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/result.h"
#include "base/system/child_process.h"
#include "ui/render/pixels.h"

namespace limber::app {

/// Checks the file name and size: a video extension, or a pattern with one %d or %05d; videos need an even size.
Result<void> check_film_file(const std::string& name, int width, int height);

/// [main]
class FilmFile {
 public:
  /// Fails if ffmpeg can't be started. [main]
  static Result<std::unique_ptr<FilmFile>> open(const std::string& name, int width, int height, double fps);
  /// Without finish(), an unfinished video is deleted. [main]
  ~FilmFile();
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  /// Appends a frame. [main]
  Result<void> add(const render::Pixels& frame);
  /// Completes the film and renames it to its final name. Writes nothing if there was no frame. [main]
  Result<void> finish();

 private:
  explicit FilmFile(std::string name) : name_(std::move(name)) {}
  Result<void> start_ffmpeg(int width, int height, double fps);
  std::string still_name(std::uint64_t number) const;

  std::string name_;
  std::string temporary_file_;  // temporary file of the video
  std::uint64_t frames_ = 0;
  system::ChildProcess ffmpeg_;
};

}  // namespace limber::app
