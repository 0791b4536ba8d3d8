// BenchFolder: a show folder for the benchmark in the system's temporary folder, deleted by the destructor.
#pragma once

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/system/process.h"

namespace limber {

/// The folder exists as long as this object.
class BenchFolder {
 public:
  BenchFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("limber_bench_{}", system::process_id())) {
    std::filesystem::create_directories(path_ / "scripts");
  }
  ~BenchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  BenchFolder(const BenchFolder&) = delete;
  BenchFolder& operator=(const BenchFolder&) = delete;

  std::string scene() const { return (path_ / "scripts" / "scene.lua").string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace limber
