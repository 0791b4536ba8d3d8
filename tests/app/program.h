// Runs the program as a child process and captures its output and exit code.
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

namespace limber::app::test {

/// Timeout that only failing tests reach.
inline constexpr int kTimeoutMs = 120000;

struct RunResult {
  int code = -1;  ///< Exit code; 128 + signal number if a signal ended it.
  std::string out;
  std::string err;
};

/// Returns the bytes of a file; empty if it can't be read.
inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A temporary folder, deleted by the destructor.
class TempFolder {
 public:
  TempFolder() {
    static std::atomic<int> count{0};
    path_ =
        std::filesystem::path(::testing::TempDir()) / fmt::format("limber_app_{}_{}", ::getpid(), count.fetch_add(1));
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

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

/// Default state folder of the programs in these tests.
inline std::string state_folder() {
  static const TempFolder folder;
  return folder.path();
}

/// A program that runs in a folder (default: the checkout), with its output captured. The destructor kills it if it
/// still runs.
class Process {
 public:
  explicit Process(const std::vector<std::string>& words, const std::string& folder = LIMBER_SOURCE_DIR) {
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
  ~Process() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    for (const int fd : pipes_) {
      if (fd >= 0) close(fd);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  pid_t pid() const { return pid_; }

  /// Reads until `text` appears on stderr (or stdout); false if the output ended before.
  bool wait_for(const std::string& text, bool on_stdout = false) {
    const std::string& where = on_stdout ? out_ : err_;
    while (where.find(text) == std::string::npos) {
      if (!read_some()) return where.find(text) != std::string::npos;
    }
    return true;
  }

  /// Reads the available output without waiting.
  void read_available() {
    while (true) {
      pollfd polled[2] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}};
      if (poll(polled, 2, 0) <= 0 || !read_some()) return;
    }
  }

  /// Reads to the end and returns the result.
  RunResult finish() {
    while (read_some()) {
    }
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out_, err_};
  }
  const std::string& err() const { return err_; }
  /// Returns the text after `prefix` on stderr, to the end of the line; empty if not found.
  std::string text_after(const std::string& prefix) const {
    const std::size_t at = err_.find(prefix);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + prefix.size();
    return err_.substr(begin, err_.find('\n', begin) - begin);
  }
  const std::string& out() const { return out_; }

 private:
  bool read_some() {
    pollfd polled[2] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}};
    if (pipes_[0] < 0 && pipes_[1] < 0) return false;
    if (poll(polled, 2, kTimeoutMs) <= 0) {
      ADD_FAILURE() << "no output for two minutes; so far:\n" << err_;
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

/// Returns the command line of the program; `before`: words in front of it (taskset, setarch).
inline std::vector<std::string> limber_command(std::vector<std::string> args, std::vector<std::string> before = {}) {
  before.emplace_back(LIMBER_PROGRAM);
  before.insert(before.end(), args.begin(), args.end());
  return before;
}

/// Prefix for programs that draw: the leak sanitizer stops all threads of a process, and sometimes crashes on those of
/// a software driver.
inline std::vector<std::string> without_leak_check() {
  const char* const options = std::getenv("ASAN_OPTIONS");
  return {"env", fmt::format("ASAN_OPTIONS={}:detect_leaks=0", options == nullptr ? "" : options)};
}

inline RunResult run(std::vector<std::string> args, const std::string& folder = LIMBER_SOURCE_DIR) {
  return Process(limber_command(std::move(args)), folder).finish();
}

/// Creates an installation: the program in bin, a scene and an empty urdf folder in share/limber.
inline std::string install_copy(const TempFolder& folder) {
  folder.file("share/limber/scripts/far.lua", "print('far')\n");
  folder.file("share/limber/urdf/readme", "");
  std::string program = folder.file("bin/limber", "");
  std::filesystem::copy_file(LIMBER_PROGRAM, program, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  return program;
}

}  // namespace limber::app::test
