// Frames go to ffmpeg or to a still each.
#include "app/film_file.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

constexpr std::array kVideos = {".mp4", ".mov", ".mkv"};

bool is_video(const std::string& name) {
  for (const char* ending : kVideos) {
    if (name.ends_with(ending)) return true;
  }
  return false;
}

struct Pattern {
  std::string before, after;
  int digits = 0;  // at least; filled with zeros
  bool good = false;
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
  p.good = true;
  return p;
}

// out.mp4 while it is made: out.part.mp4, so that its ending says what it is
std::string beside(const std::string& name) {
  const std::filesystem::path path(name);
  return (path.parent_path() / (path.stem().string() + ".part" + path.extension().string())).string();
}

}  // namespace

Result<void> check_film_file(const std::string& name, int width, int height) {
  if (is_video(name)) {
    if (width % 2 == 0 && height % 2 == 0) return {};
    return Error{fmt::format("--size {}x{}: a video's width and height are even; {}x{} would do", width, height,
                             width + width % 2, height + height % 2)};
  }
  if (pattern_of(name).good) return {};
  return Error{
      fmt::format("--render '{}': give a video's name, such as film.mp4, or a pattern for stills, such as "
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
  beside_ = beside(name_);
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
                                          "-y",        beside_};
  const int fault = ffmpeg_.start(words);
  if (fault == 0) return {};
  return Error{
      fmt::format("a video needs ffmpeg, which can't be called: {}; on Debian apt-get install ffmpeg, or draw "
                  "stills with --render shot_%05d.png",
                  std::strerror(fault))};
}

FilmFile::~FilmFile() {
  if (!ffmpeg_.started()) return;
  ffmpeg_.kill();
  std::remove(beside_.c_str());
}

std::string FilmFile::still(std::uint64_t number) const {
  const Pattern p = pattern_of(name_);
  return fmt::format("{}{:0{}}{}", p.before, number, p.digits, p.after);
}

Result<void> FilmFile::add(const Pixels& frame) {
  if (!ffmpeg_.started()) return write_png(frame, still(frames_++));
  if (!ffmpeg_.write({reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()}))
    return Error{fmt::format("ffmpeg took no more of '{}'; what it says stands above", printable(name_))};
  frames_++;
  return {};
}

Result<void> FilmFile::finish() {
  if (!ffmpeg_.started()) return {};
  const bool well = ffmpeg_.finish();
  if (well && frames_ > 0 && std::rename(beside_.c_str(), name_.c_str()) == 0) return {};
  std::remove(beside_.c_str());
  if (frames_ == 0) return {};
  return Error{fmt::format("ffmpeg made no '{}'; what it says stands above", printable(name_))};
}

}  // namespace limber
