// Asks the dynamic linker for the file of this function. It returns the name used to start the program, so a name
// without a folder is searched in PATH like the shell does, and a relative path is resolved in the working directory.
#include "base/system/executable_path.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/text.h"

namespace limber::system {

namespace fs = std::filesystem;

namespace {

std::string find_executable() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&executable_path), &info) == 0 || info.dli_fname == nullptr) return {};
  const std::string called = info.dli_fname;
  std::error_code fault;
  if (called.find('/') != std::string::npos) {
    const fs::path whole = fs::canonical(called, fault);
    return fault ? std::string() : whole.string();
  }
  const char* const path = std::getenv("PATH");
  for (const std::string_view folder : split(path == nullptr ? "" : path, ':')) {
    const fs::path whole = fs::canonical(fs::path(folder) / called, fault);
    if (!fault && fs::is_regular_file(whole, fault)) return whole.string();
  }
  return {};
}

// Initialized before main(), before the working directory can change.
const std::string kFound = find_executable();

}  // namespace

std::string executable_path() { return kFound; }

}  // namespace limber::system
