// Starts child processes with posix_spawn().
#include "base/system/child_process.h"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "base/system/file.h"
#include "base/system/open.h"

#if defined(__APPLE__)
extern char** environ;
#endif

namespace limber::system {

ChildProcess::~ChildProcess() { kill(); }

void ChildProcess::kill() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  waitpid(std::exchange(pid_, -1), nullptr, 0);
}

int ChildProcess::start(const std::vector<std::string>& words, bool quietly) {
  Descriptor read_end;
  Descriptor write_end;
  Descriptor output;
  Descriptor child_output;
  if (!open_pipe(read_end, write_end) || (quietly && !open_pipe(output, child_output))) return errno;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, read_end.fd(), 0);
  if (quietly) {
    posix_spawn_file_actions_adddup2(&files, child_output.fd(), 1);
    posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
  }
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
  pid_t pid = -1;
  const int fault = posix_spawnp(&pid, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (fault != 0) return fault;
  pid_ = pid;
  input_ = std::move(write_end);
  output_ = std::move(output);
  return 0;
}

bool ChildProcess::write(std::string_view bytes) { return write_all(input_.fd(), bytes); }

bool ChildProcess::finish() {
  { const Descriptor closed = std::move(input_); }
  int status = 0;
  const pid_t ended = waitpid(std::exchange(pid_, -1), &status, 0);
  return ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace limber::system
