// The dynamic linker knows the file that holds this function: as it was called, so a name without a folder is looked
// for in PATH, as the shell did, and a relative one in the folder where the program was started.
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

// before main(): the program has not left its folder yet
const std::string kFound = find_executable();

}  // namespace

std::string executable_path() { return kFound; }

}  // namespace limber::system
