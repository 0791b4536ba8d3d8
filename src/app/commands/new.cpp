// Instantiates the templates of src/app/templates, which are embedded in the program.
#include "app/commands/commands.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/exit_code.h"
#include "app/paths.h"
#include "base/build_info.h"
#include "base/check.h"
#include "base/embedded.h"
#include "base/log/output.h"
#include "base/system/file.h"
#include "base/text.h"
#include "script/scene/script_files.h"
#include "sim/behavior/behavior_type.h"

namespace limber::app {

/// The files of src/app/templates, embedded by the build.
std::span<const EmbeddedFile> template_files();

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxName = 64;

// lower-case letters, digits and _, so that the name is valid as a file, an address and a Lua identifier
bool is_valid_template_name(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
  constexpr std::string_view kAll = "abcdefghijklmnopqrstuvwxyz0123456789_";
  return !name.empty() && name.size() <= kMaxName && kLetters.find(name[0]) != std::string_view::npos &&
         name.find_first_not_of(kAll) == std::string_view::npos;
}

// suggests a valid name that is similar to this one
std::string suggest_name(std::string_view name) {
  std::string suggestion;
  for (const char c : name.substr(0, kMaxName)) {
    const char small = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (is_valid_template_name("a" + std::string(1, small))) {
      if (!suggestion.empty() || is_valid_template_name(std::string(1, small))) suggestion += small;
    } else if (!suggestion.empty() && suggestion.back() != '_') {
      suggestion += '_';
    }
  }
  while (suggestion.ends_with('_')) suggestion.pop_back();
  return suggestion;
}

std::string fill_template(std::string_view text, std::string_view name) {
  const fs::path data = data_dir().empty() ? fs::path(install_data_dir()) : fs::path(data_dir());
  // escaped for a JSON string
  const std::string library = nlohmann::json((data / "scripts" / "library").string()).dump(-1, ' ', true);
  const std::pair<std::string_view, std::string> replacements[] = {
      {"{{NAME}}", printable(name)}, {"{{LIBRARY}}", library.substr(1, library.size() - 2)}};
  std::string out(text);
  for (const auto& [placeholder, value] : replacements) {
    for (std::size_t at = out.find(placeholder); at != std::string::npos; at = out.find(placeholder, at + value.size()))
      out.replace(at, placeholder.size(), value);
  }
  return out;
}

// writes a file that must not exist; returns 0 or errno
int write_new(const fs::path& path, std::string_view text) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return error.value();
  const system::Descriptor file = system::open_file(path.string(), system::OpenMode::create_new, 0666);
  return file.is_open() && system::write_all(file.fd(), text) ? 0 : errno;
}

// writes the file, prints its name and returns the exit code
int write_and_report(const fs::path& path, std::string_view text) {
  const int error = write_new(path, text);
  if (error == EEXIST)
    return fail(kInputError,
                fmt::format("new: {} already exists and is not overwritten; choose another name", path.string()));
  if (error != 0) {
    const bool by_path = error == ENOTDIR || error == ENAMETOOLONG || error == ELOOP;
    const bool full = error == ENOSPC || error == EDQUOT;
    return fail(by_path ? kInputError : kMachineError,
                fmt::format("new: {} can't be written: {}; {}", path.string(), std::generic_category().message(error),
                            by_path ? "choose another place"
                            : full  ? "free disk space"
                                    : "check the folder's permissions"));
  }
  print_result("{}\n", printable(path.string()));
  return kSuccess;
}

int new_show(const std::string& folder) {
  if (folder.empty() || printable(folder) != folder || folder.find_first_of("\n\t") != std::string::npos) {
    return fail(kUsageError,
                fmt::format("new: '{}' is not a valid folder name: use printable text, such as my_show", folder));
  }
  std::error_code error;
  const fs::path root(folder);
  if (fs::exists(root, error) && !(fs::is_directory(root, error) && fs::is_empty(root, error)))
    return fail(kInputError, fmt::format("new: {} already exists; choose a new or empty folder", folder));
  const std::string name = fs::absolute(root, error).lexically_normal().filename().string();
  const std::string title = name.empty() ? fs::absolute(root, error).parent_path().filename().string() : name;
  constexpr std::string_view kFolder = "show/";
  for (const EmbeddedFile& file : template_files()) {
    if (!file.name.starts_with(kFolder)) continue;
    std::string path(file.name.substr(kFolder.size()));
    if (path == "luarc.json") path = ".luarc.json";
    if (const int code = write_and_report(root / path, fill_template(file.text, title)); code != kSuccess) return code;
  }
  print_result("\nNext:  cd {} && {} play scripts/main.lua\n", shell_word(folder), program_command());
  return kSuccess;
}

// the nearest folder at or above the current one that contains scripts/; empty: none
fs::path show_folder() {
  std::error_code error;
  const fs::path here = fs::current_path(error);
  const fs::path show = script::ScriptFiles((here / "scene.lua").string(), "").show_folder();
  return !error && fs::is_directory(show / "scripts", error) ? show : fs::path();
}

// returns why a behavior can't have this name in a show: the name (normalized as in scenes) belongs to an existing type
std::string name_conflict(const fs::path& show, std::string_view name) {
  const sim::BehaviorTypes built_in;
  const auto is = [&](std::string_view type) {
    return type == name ? fmt::format("'{}' is", name) : fmt::format("'{}' means '{}', which is", name, type);
  };
  if (const auto type = built_in.find(name)) return is(type->name) + " a built-in behavior type";
  const std::string found =
      script::ScriptFiles((show / "scripts" / "scene.lua").string(), data_dir()).find_behavior(name);
  if (found.empty()) return {};
  const std::string type = fs::path(found).stem().string();
  std::error_code error;
  const bool of_the_show = fs::equivalent(fs::path(found).parent_path(), show / "behaviors_lua", error);
  if (of_the_show) return type == name ? "" : fmt::format("{} an existing behavior: {}", is(type), found);
  constexpr std::string_view kTwin = "lua_";
  if (type.starts_with(kTwin) && built_in.find(type.substr(kTwin.size())) != nullptr) {
    return fmt::format("{} a behavior of Limber that scenes depend on: {}", is(type), found);
  }
  print_notice("new: note: in this show it replaces {}", printable(found));
  return {};
}

int new_file(const NewCommand& command) {
  const bool scene = command.kind == NewCommand::Kind::scene;
  const std::string_view kind = scene ? "scene" : "behavior";
  std::string name = command.name;
  if (name.ends_with(".lua")) name.resize(name.size() - 4);
  if (!is_valid_template_name(name)) {
    const std::string near = suggest_name(name);
    return fail(kUsageError,
                fmt::format("new: '{}' is not a valid {} name: use lower-case letters, digits and _, starting with a "
                            "letter, at most {} characters{}",
                            command.name, kind, kMaxName, near.empty() ? "" : fmt::format("; such as '{}'", near)));
  }
  const fs::path show = show_folder();
  if (show.empty()) {
    return fail(
        kInputError,
        "new: no show found here. Change to its folder (which contains scripts/), or create one: limber new show DIR");
  }
  if (!scene) {
    if (const std::string reason = name_conflict(show, name); !reason.empty())
      return fail(
          kInputError,
          "new: " + reason + "; choose another name (case, underscores and a trailing 'behavior' make no difference)");
  }
  const EmbeddedFile* const text = find_embedded(template_files(), scene ? "scene.lua" : "behavior.lua");
  LIMBER_CHECK(text != nullptr);
  const fs::path path = show / (scene ? "scripts" : "behaviors_lua") / (name + ".lua");
  if (const int code = write_and_report(path, fill_template(text->text, name)); code != kSuccess) return code;
  if (scene) {
    print_result("\nNext:  {} play {}\n", program_command(), shell_word(path.string()));
  } else {
    print_result("\nNext:  in a scene, body:add_behavior(\"{0}\", \"my_{0}\")\n", name);
  }
  return kSuccess;
}

}  // namespace

int new_command(const NewCommand& command) {
  return command.kind == NewCommand::Kind::show ? new_show(command.name) : new_file(command);
}

}  // namespace limber::app
