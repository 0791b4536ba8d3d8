// Writes frames to ffmpeg or to single PNG files.
#include "app/view/film_file.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::app {

namespace {

constexpr std::array kVideos = {".mp4", ".mov", ".mkv"};

bool is_video(const std::string& name) {
  for (const char* extension : kVideos) {
    if (name.ends_with(extension)) return true;
  }
  return false;
}

struct Pattern {
  std::string before, after;
  int digits = 0;  // minimal number, padded with zeros
  bool valid = false;
};

// "shot_%05d.png"
Pattern pattern_of(const std::string& name) {
  Pattern p;
  const std::size_t at = name.find('%');
  if (at == std::string::npos || name.find('%', at + 1) != std::string::npos) return p;
  const std::size_t d = name.find('d', at);
  if (d == std::string::npos || !name.ends_with(".png")) return p;
  const std::string digits = name.substr(at + 1, d - at - 1);
  if (digits.find_first_not_of("0123456789") != std::string::npos || digits.size() > 3) return p;
  if (!digits.empty()) {
    if (digits[0] != '0') return p;
    p.digits = std::min(std::stoi(digits), 20);
  }
  p.before = name.substr(0, at);
  p.after = name.substr(d + 1);
  p.valid = true;
  return p;
}

// temporary name of out.mp4: out.part.mp4, which keeps the extension for ffmpeg
std::string temporary_name(const std::string& name) {
  const std::filesystem::path path(name);
  return (path.parent_path() / (path.stem().string() + ".part" + path.extension().string())).string();
}

}  // namespace

Result<void> check_film_file(const std::string& name, int width, int height) {
  if (is_video(name)) {
    if (width % 2 == 0 && height % 2 == 0) return {};
    return Error{fmt::format("--size {}x{}: the width and height of a video must be even; use {}x{}", width, height,
                             width + width % 2, height + height % 2)};
  }
  if (pattern_of(name).valid) return {};
  return Error{
      fmt::format("--render '{}': expected a video file, such as film.mp4, or a pattern for images, such as "
                  "shot_%05d.png",
                  printable(name))};
}

Result<std::unique_ptr<FilmFile>> FilmFile::open(const std::string& name, int width, int height, double fps) {
  std::unique_ptr<FilmFile> film(new FilmFile(name));
  if (is_video(name)) {
    if (Result<void> started = film->start_ffmpeg(width, height, fps); !started) return Error{started.error()};
  }
  return film;
}

Result<void> FilmFile::start_ffmpeg(int width, int height, double fps) {
  temporary_file_ = temporary_name(name_);
  const std::vector<std::string> words = {"ffmpeg",    "-nostdin",
                                          "-v",        "error",
                                          "-f",        "rawvideo",
                                          "-pix_fmt",  "rgba",
                                          "-s",        fmt::format("{}x{}", width, height),
                                          "-r",        fmt::format("{}", fps),
                                          "-i",        "-",
                                          "-c:v",      "libx264",
                                          "-preset",   "veryfast",
                                          "-crf",      "18",
                                          "-pix_fmt",  "yuv420p",
                                          "-movflags", "+faststart",
                                          "-y",        temporary_file_};
  const int error = ffmpeg_.start(words);
  if (error == 0) return {};
  return Error{
      fmt::format("ffmpeg, which is needed for videos, can't be started: {}. On Debian: apt-get install ffmpeg. Or "
                  "render images with --render shot_%05d.png",
                  std::strerror(error))};
}

FilmFile::~FilmFile() {
  if (!ffmpeg_.started()) return;
  ffmpeg_.kill();
  std::remove(temporary_file_.c_str());
}

std::string FilmFile::still_name(std::uint64_t number) const {
  const Pattern p = pattern_of(name_);
  return fmt::format("{}{:0{}}{}", p.before, number, p.digits, p.after);
}

Result<void> FilmFile::add(const render::Pixels& frame) {
  if (!ffmpeg_.started()) return render::write_png(frame, still_name(frames_++));
  if (!ffmpeg_.write({reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()}))
    return Error{fmt::format("ffmpeg stopped reading '{}'; see its messages above", printable(name_))};
  frames_++;
  return {};
}

Result<void> FilmFile::finish() {
  if (!ffmpeg_.started()) return {};
  const bool succeeded = ffmpeg_.finish();
  if (succeeded && frames_ > 0 && std::rename(temporary_file_.c_str(), name_.c_str()) == 0) return {};
  std::remove(temporary_file_.c_str());
  if (frames_ == 0) return {};
  return Error{fmt::format("ffmpeg failed to write '{}'; see its messages above", printable(name_))};
}

}  // namespace limber::app
