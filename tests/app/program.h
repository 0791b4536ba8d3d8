// Runs the program itself, as somebody at a terminal would: arguments in, output, errors and exit code out.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limber::app_test {

/// Only a failing test waits as long.
inline constexpr int kPatienceMs = 120000;

struct Ran {
  int code = -1;  ///< Exit code; 128 + signal when one ended it.
  std::string out;
  std::string err;
};

/// The bytes of a file; none where it can't be read.
inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder that goes when the test is over.
class Folder {
 public:
  Folder() {
    static std::atomic<int> count{0};
    path_ =
        std::filesystem::path(::testing::TempDir()) / fmt::format("limber_app_{}_{}", ::getpid(), count.fetch_add(1));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path() const { return path_.string(); }
  std::string file(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }

 private:
  std::filesystem::path path_;
};

/// What programs of these tests remember of themselves goes there, unless a test says otherwise.
inline std::string state_folder() {
  static const Folder folder;
  return folder.path();
}

/// A program that runs in a folder (the checkout), with its output read as it comes. What still runs at the end is
/// ended, by its id.
class Running {
 public:
  explicit Running(const std::vector<std::string>& words, const std::string& folder = LIMBER_SOURCE_DIR) {
    int out[2];
    int err[2];
    if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) std::abort();
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const std::string state = state_folder();
    pid_ = fork();
    if (pid_ == 0) {
      setenv("XDG_STATE_HOME", state.c_str(), 1);
      if (chdir(folder.c_str()) != 0) _exit(126);
      dup2(open("/dev/null", O_RDONLY), 0);
      dup2(out[1], 1);
      dup2(err[1], 2);
      execvp(argv[0], argv.data());
      _exit(127);
    }
    close(out[1]);
    close(err[1]);
    pipes_[0] = out[0];
    pipes_[1] = err[0];
  }
  ~Running() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    for (const int fd : pipes_) {
      if (fd >= 0) close(fd);
    }
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  pid_t pid() const { return pid_; }

  /// Reads until `text` has come on stderr (or stdout); false when the output ended before.
  bool wait_for(const std::string& text, bool on_stdout = false) {
    const std::string& where = on_stdout ? out_ : err_;
    while (where.find(text) == std::string::npos) {
      if (!read_some()) return where.find(text) != std::string::npos;
    }
    return true;
  }

  /// Reads what has come so far, without waiting.
  void look() {
    while (true) {
      pollfd polled[2] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}};
      if (poll(polled, 2, 0) <= 0 || !read_some()) return;
    }
  }

  /// Reads to the end and gives what it was.
  Ran finish() {
    while (read_some()) {
    }
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out_, err_};
  }
  const std::string& err() const { return err_; }
  /// What came on stderr behind `mark`, to the end of its line; empty when it did not come.
  std::string behind(const std::string& mark) const {
    const std::size_t at = err_.find(mark);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + mark.size();
    return err_.substr(begin, err_.find('\n', begin) - begin);
  }
  const std::string& out() const { return out_; }

 private:
  bool read_some() {
    pollfd polled[2] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}};
    if (pipes_[0] < 0 && pipes_[1] < 0) return false;
    if (poll(polled, 2, kPatienceMs) <= 0) {
      ADD_FAILURE() << "nothing came for two minutes; so far:\n" << err_;
      return false;
    }
    for (int i = 0; i < 2; i++) {
      if (polled[i].fd < 0 || polled[i].revents == 0) continue;
      char buffer[4096];
      const ssize_t n = read(pipes_[i], buffer, sizeof buffer);
      if (n > 0) {
        (i == 0 ? out_ : err_).append(buffer, static_cast<std::size_t>(n));
      } else {
        close(std::exchange(pipes_[i], -1));
      }
    }
    return true;
  }

  pid_t pid_ = -1;
  int pipes_[2] = {-1, -1};
  std::string out_;
  std::string err_;
};

/// The program with these arguments; `before` are words in front of it (taskset, setarch).
inline std::vector<std::string> limber(std::vector<std::string> args, std::vector<std::string> before = {}) {
  before.emplace_back(LIMBER_PROGRAM);
  before.insert(before.end(), args.begin(), args.end());
  return before;
}

/// Before a program that draws: the leak sanitizer stops a process's threads to look at them, and crashes now and then
/// where they are a software driver's.
inline std::vector<std::string> without_leak_search() {
  const char* const options = std::getenv("ASAN_OPTIONS");
  return {"env", fmt::format("ASAN_OPTIONS={}:detect_leaks=0", options == nullptr ? "" : options)};
}

inline Ran run(std::vector<std::string> args, const std::string& folder = LIMBER_SOURCE_DIR) {
  return Running(limber(std::move(args)), folder).finish();
}

/// The program as it is installed: in bin, with a scene and an (empty) urdf folder in share/limber.
inline std::string install_copy(const Folder& folder) {
  folder.file("share/limber/scripts/far.lua", "print('far')\n");
  folder.file("share/limber/urdf/readme", "");
  std::string program = folder.file("bin/limber", "");
  std::filesystem::copy_file(LIMBER_PROGRAM, program, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  return program;
}

}  // namespace limber::app_test
