// Searches the folders of the program, its installation and the user.
#include "app/paths.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/build_info.h"
#include "base/system/executable_path.h"
#include "base/system/file.h"
#include "base/text.h"

namespace limber::app {

namespace fs = std::filesystem;

std::string data_dir() {
  std::error_code error;
  const fs::path program = system::executable_path();
  std::vector<fs::path> candidates;
  if (!program.empty()) {
    // a build folder may be nested: build/asan
    const fs::path above = program.parent_path().parent_path();
    candidates = {above, above.parent_path(), above / "share/limber"};
  }
  candidates.emplace_back(install_data_dir());
  for (const fs::path& candidate : candidates) {
    if (fs::is_directory(candidate / "scripts", error) && fs::is_directory(candidate / "urdf", error))
      return candidate.string();
  }
  return {};
}

std::string find_in_path(std::string_view name) {
  const char* const path = std::getenv("PATH");
  for (const std::string_view folder : split(path == nullptr ? "" : path, ':')) {
    std::string file = fmt::format("{}/{}", folder.empty() ? "." : folder, name);
    if (system::is_executable(file)) return file;
  }
  return {};
}

std::string shell_word(std::string_view text) {
  std::string word = printable(text);
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:@%=";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string program_command() {
  const std::string program = system::executable_path();
  std::error_code error;
  if (program.empty() || fs::equivalent(find_in_path("limber"), program, error)) return "limber";
  return shell_word(program);
}

std::string link_program() {
  const std::string beside = (fs::path(system::executable_path()).parent_path() / "limber-link").string();
  return system::is_executable(beside) ? beside : "limber-link";
}

std::string module_file(std::string_view name) {
  const fs::path folder = fs::path(system::executable_path()).parent_path();
  for (const fs::path& place : {folder, folder.parent_path() / "lib" / "limber"}) {
    std::error_code error;
    if (fs::path file = place / name; fs::is_regular_file(file, error)) return file.string();
  }
  return {};
}

std::string shader_dir() {
  const std::string data = data_dir();
  std::error_code error;
  if (data.empty() || !fs::is_regular_file(fs::path(data) / "shaders/common.glsl", error)) return {};
  return (fs::path(data) / "shaders").string();
}

std::string site_dir() {
  std::error_code error;
  const fs::path program = system::executable_path();
  std::vector<fs::path> candidates;
  if (!program.empty()) {
    const fs::path folder = program.parent_path();
    // the second one for a nested build folder: build/asan
    candidates = {folder / "site", folder.parent_path() / "site", folder.parent_path() / "share/doc/limber/html"};
  }
  candidates.push_back(fs::path(install_data_dir()).parent_path() / "doc/limber/html");
  for (const fs::path& candidate : candidates) {
    if (fs::is_regular_file(candidate / "index.html", error)) return candidate.lexically_normal().string();
  }
  return {};
}

std::string state_dir() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && state[0] == '/') return std::string(state) + "/limber";
  const char* home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.local/state/limber" : "";
}

std::string find_file_or_folder(std::string_view name, std::vector<std::string>& searched) {
  if (name.empty()) return {};
  std::vector<fs::path> candidates{fs::path(name)};
  const std::string data = data_dir();
  if (!data.empty() && fs::path(name).is_relative()) candidates.push_back(fs::path(data) / name);
  std::error_code error;
  for (const fs::path& candidate : candidates) {
    if (fs::is_regular_file(candidate, error) || fs::is_directory(candidate, error)) return candidate.string();
    // in the data folder itself both places are the same
    const std::string absolute = fs::absolute(candidate, error).lexically_normal().string();
    if (searched.empty() || searched.back() != absolute) searched.push_back(absolute);
  }
  return {};
}

std::string absolute_path(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error || path.empty() ? path : absolute.lexically_normal().string();
}

std::string scene_not_found(std::string_view name, const std::vector<std::string>& searched) {
  if (name.empty()) return "the scene's name is empty; leave it out to play scripts/arms.lua";
  return fmt::format(
      "'{}' not found; searched {}; play a .lua scene such as scripts/hello.lua, a .urdf or .xml (MJCF) model, or a "
      "folder with one model",
      name, fmt::join(searched, " and "));
}

}  // namespace limber::app
