// Reads the link /proc/self/exe.
#include "base/system/executable_path.h"

#include <filesystem>

namespace limber::system {

std::string executable_path() {
  std::error_code fault;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", fault);
  return fault ? std::string() : program.string();
}

}  // namespace limber::system
