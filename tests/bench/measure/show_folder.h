// ShowFolder: a show folder in the system's temporary folder, deleted by the destructor.
#pragma once

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/system/process.h"

namespace limber {

/// The folder exists as long as this object.
class ShowFolder {
 public:
  ShowFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("limber_bench_{}", system::process_id())) {
    std::filesystem::create_directories(path_ / "scripts");
  }
  ~ShowFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ShowFolder(const ShowFolder&) = delete;
  ShowFolder& operator=(const ShowFolder&) = delete;

  std::string scene() const { return (path_ / "scripts" / "scene.lua").string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace limber
