// Finding the program's data.
#include "app/paths.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/build_info.h"
#include "base/system/executable_path.h"
#include "base/system/file.h"
#include "base/text.h"

namespace limber {

namespace fs = std::filesystem;

std::string data_dir() {
  std::error_code fault;
  const fs::path program = system::executable_path();
  std::vector<fs::path> places;
  if (!program.empty()) {
    // a checkout's build folder may lie deeper: build/asan
    const fs::path above = program.parent_path().parent_path();
    places = {above, above.parent_path(), above / "share/limber"};
  }
  places.emplace_back(install_data_dir());
  for (const fs::path& place : places) {
    if (fs::is_directory(place / "scripts", fault) && fs::is_directory(place / "urdf", fault)) return place.string();
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
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string program_command() {
  const std::string program = system::executable_path();
  std::error_code fault;
  if (program.empty() || fs::equivalent(find_in_path("limber"), program, fault)) return "limber";
  return shell_word(program);
}

std::string shader_dir() {
  const std::string data = data_dir();
  std::error_code fault;
  if (data.empty() || !fs::is_regular_file(fs::path(data) / "shaders/common.glsl", fault)) return {};
  return (fs::path(data) / "shaders").string();
}

std::string state_dir() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && state[0] == '/') return std::string(state) + "/limber";
  const char* home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.local/state/limber" : "";
}

std::string find_scene(std::string_view name, std::vector<std::string>& looked) {
  if (name.empty()) return {};
  std::vector<fs::path> places{fs::path(name)};
  const std::string data = data_dir();
  if (!data.empty() && fs::path(name).is_relative()) places.push_back(fs::path(data) / name);
  std::error_code fault;
  for (const fs::path& place : places) {
    if (fs::is_regular_file(place, fault)) return place.string();
    // called from the data's own folder, both places are one
    const std::string whole = fs::absolute(place, fault).lexically_normal().string();
    if (looked.empty() || looked.back() != whole) looked.push_back(whole);
  }
  return {};
}

std::string no_scene(std::string_view name, const std::vector<std::string>& looked) {
  if (name.empty()) return "the scene's name is empty; leave it out to play scripts/arms.lua";
  return fmt::format("there is no scene '{}'; looked for {}; a scene is a .lua file, such as scripts/hello.lua", name,
                     fmt::join(looked, " and "));
}

}  // namespace limber
