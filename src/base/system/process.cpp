// Process information of POSIX, and lookups with the dynamic linker.
#include "base/system/process.h"

#include <dlfcn.h>
#include <link.h>
#include <pthread.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

namespace limber::system {

int process_id() { return getpid(); }

bool is_process_running(int pid) { return kill(pid, 0) == 0 || errno != ESRCH; }

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

unsigned fork_count() {
  static std::atomic<unsigned> forks{0};
  [[maybe_unused]] static const int registered =
      pthread_atfork(nullptr, nullptr, [] { forks.fetch_add(1, std::memory_order_relaxed); });
  return forks.load(std::memory_order_relaxed);
}

std::string library_path(const void* address) {
  Dl_info info{};
  if (dladdr(address, &info) == 0 || info.dli_fname == nullptr) return {};
  char* const path = realpath(info.dli_fname, nullptr);
  if (path == nullptr) return {};
  std::string text = path;
  std::free(path);
  return text;
}

void* find_symbol(const char* name) {
  if (void* const found = dlsym(RTLD_DEFAULT, name)) return found;
  // GLFW since 3.4 and others load libraries with RTLD_LOCAL; search each loaded library.
  std::vector<std::string> libraries;
  const auto add = [](dl_phdr_info* info, std::size_t, void* list) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(info->dlpi_name);
    return 0;
  };
  dl_iterate_phdr(add, &libraries);
  for (const std::string& library : libraries) {
    void* const loaded = library.empty() ? nullptr : dlopen(library.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (loaded == nullptr) continue;
    void* const found = dlsym(loaded, name);
    dlclose(loaded);
    if (found != nullptr) return found;
  }
  return nullptr;
}

bool load_library(const char* file) { return dlopen(file, RTLD_LAZY | RTLD_LOCAL) != nullptr; }

void* load_function(const std::string& file, const char* name, std::string& reason) {
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const found = library == nullptr ? nullptr : dlsym(library, name);
  if (found != nullptr) return found;
  const char* const fault = dlerror();
  reason = fault == nullptr ? "unknown error" : fault;
  return nullptr;
}

}  // namespace limber::system
