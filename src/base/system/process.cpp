// POSIX, and the dynamic linker.
#include "base/system/process.h"

#include <dlfcn.h>
#include <signal.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace limber::system {

int process_id() { return getpid(); }

bool process_runs(int pid) { return kill(pid, 0) == 0 || errno != ESRCH; }

long user_id() { return static_cast<long>(geteuid()); }

bool at_terminal() { return isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0; }

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string machine_name() {
  utsname machine{};
  uname(&machine);
  return std::string(machine.sysname) + " " + machine.machine;
}

void* find_symbol(const char* name) { return dlsym(RTLD_DEFAULT, name); }

}  // namespace limber::system
