// ffmpeg in a process group of its own, so that Ctrl+C is heard by this program alone.
#include "app/film_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
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
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return Error{fmt::format("no pipe to ffmpeg: {}", std::strerror(errno))};
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
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  sigset_t pipe_signal;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &pipe_signal);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int fault = posix_spawnp(&ffmpeg_, "ffmpeg", &files, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (fault == 0) return {};
  ffmpeg_ = -1;
  return Error{
      fmt::format("a video needs ffmpeg, which can't be called: {}; on Debian apt-get install ffmpeg, or draw "
                  "stills with --render shot_%05d.png",
                  std::strerror(fault))};
}

FilmFile::~FilmFile() {
  if (pipe_ >= 0) ::close(pipe_);
  if (ffmpeg_ < 0) return;
  ::kill(ffmpeg_, SIGKILL);
  waitpid(ffmpeg_, nullptr, 0);
  std::remove(beside_.c_str());
}

std::string FilmFile::still(std::uint64_t number) const {
  const Pattern p = pattern_of(name_);
  return fmt::format("{}{:0{}}{}", p.before, number, p.digits, p.after);
}

Result<void> FilmFile::add(const Pixels& frame) {
  if (ffmpeg_ < 0) return write_png(frame, still(frames_++));
  const std::uint8_t* from = frame.bytes.data();
  std::size_t left = frame.bytes.size();
  while (left > 0) {
    const ssize_t n = ::write(pipe_, from, left);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return Error{fmt::format("ffmpeg took no more of '{}'; what it says stands above", printable(name_))};
    from += n;
    left -= static_cast<std::size_t>(n);
  }
  frames_++;
  return {};
}

bool FilmFile::end_ffmpeg() {
  ::close(std::exchange(pipe_, -1));
  int status = 0;
  const pid_t ended = waitpid(std::exchange(ffmpeg_, -1), &status, 0);
  return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

Result<void> FilmFile::finish() {
  if (ffmpeg_ < 0) return {};
  const bool well = end_ffmpeg();
  if (well && frames_ > 0 && std::rename(beside_.c_str(), name_.c_str()) == 0) return {};
  std::remove(beside_.c_str());
  if (frames_ == 0) return {};
  return Error{fmt::format("ffmpeg made no '{}'; what it says stands above", printable(name_))};
}

}  // namespace limber
