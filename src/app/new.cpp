// Templates (src/app/templates, inside the program) with names filled in.
#include "app/new.h"

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
#include "base/output.h"
#include "base/system/file.h"
#include "base/text.h"
#include "script/files.h"
#include "sim/behavior_type.h"

namespace limber {

/// The files of src/app/templates, which the build puts inside the program.
std::span<const EmbeddedFile> template_files();

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostName = 64;

// small letters, digits and _, so that it can be a file, an address and a word in Lua
bool good_name(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
  constexpr std::string_view kAll = "abcdefghijklmnopqrstuvwxyz0123456789_";
  return !name.empty() && name.size() <= kMostName && kLetters.find(name[0]) != std::string_view::npos &&
         name.find_first_not_of(kAll) == std::string_view::npos;
}

// what would be a good name and looks like this one
std::string nearest_good_name(std::string_view name) {
  std::string good;
  for (const char c : name.substr(0, kMostName)) {
    const char small = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (good_name("a" + std::string(1, small))) {
      if (!good.empty() || good_name(std::string(1, small))) good += small;
    } else if (!good.empty() && good.back() != '_') {
      good += '_';
    }
  }
  while (good.ends_with('_')) good.pop_back();
  return good;
}

std::string filled(std::string_view text, std::string_view name) {
  const fs::path data = data_dir().empty() ? fs::path(install_data_dir()) : fs::path(data_dir());
  // as it stands between the quotes of a JSON text
  const std::string library = nlohmann::json((data / "scripts" / "library").string()).dump(-1, ' ', true);
  const std::pair<std::string_view, std::string> fillings[] = {{"{{NAME}}", printable(name)},
                                                               {"{{LIBRARY}}", library.substr(1, library.size() - 2)}};
  std::string out(text);
  for (const auto& [mark, value] : fillings) {
    for (std::size_t at = out.find(mark); at != std::string::npos; at = out.find(mark, at + value.size()))
      out.replace(at, mark.size(), value);
  }
  return out;
}

// writes a file that must not be there; 0, or the error's number
int write_new(const fs::path& path, std::string_view text) {
  std::error_code fault;
  fs::create_directories(path.parent_path(), fault);
  if (fault) return fault.value();
  const system::Descriptor file = system::open_file(path.string(), system::OpenMode::create_new, 0666);
  return file.open() && system::write_all(file.fd(), text) ? 0 : errno;
}

// writes it and says so; the exit code
int write_and_say(const fs::path& path, std::string_view text) {
  const int fault = write_new(path, text);
  if (fault == EEXIST)
    return fail(kInput, fmt::format("new: {} is there already and stays as it is; choose another name", path.string()));
  if (fault != 0) {
    const bool by_path = fault == ENOTDIR || fault == ENAMETOOLONG || fault == ELOOP;
    const bool full = fault == ENOSPC || fault == EDQUOT;
    return fail(by_path ? kInput : kMachine,
                fmt::format("new: {} can't be written: {}; {}", path.string(), std::generic_category().message(fault),
                            by_path ? "choose another place"
                            : full  ? "make room on the disk"
                                    : "look at the folder's permissions"));
  }
  print_result("{}\n", printable(path.string()));
  return kFine;
}

int new_show(const std::string& folder) {
  if (folder.empty() || printable(folder) != folder || folder.find_first_of("\n\t") != std::string::npos) {
    return fail(kUsage,
                fmt::format("new: '{}' can't be a show's folder: its name is printable text; such as my_show", folder));
  }
  std::error_code fault;
  const fs::path root(folder);
  if (fs::exists(root, fault) && !(fs::is_directory(root, fault) && fs::is_empty(root, fault)))
    return fail(kInput, fmt::format("new: {} is there already; name a folder that is new or empty", folder));
  const std::string name = fs::absolute(root, fault).lexically_normal().filename().string();
  const std::string title = name.empty() ? fs::absolute(root, fault).parent_path().filename().string() : name;
  constexpr std::string_view kFolder = "show/";
  for (const EmbeddedFile& file : template_files()) {
    if (!file.name.starts_with(kFolder)) continue;
    std::string path(file.name.substr(kFolder.size()));
    if (path == "luarc.json") path = ".luarc.json";
    if (const int code = write_and_say(root / path, filled(file.text, title)); code != kFine) return code;
  }
  print_result("\nNext:  cd {} && {} play scripts/main.lua\n", shell_word(folder), program_command());
  return kFine;
}

// the nearest folder at or above this one that holds scripts/; empty: none
fs::path show_folder() {
  std::error_code fault;
  const fs::path here = fs::current_path(fault);
  const fs::path show = ScriptFiles((here / "scene.lua").string(), "").show_folder();
  return !fault && fs::is_directory(show / "scripts", fault) ? show : fs::path();
}

// what speaks against a behaviour of this name in a show: by the naming rule it would be another type that is there
std::string taken_type(const fs::path& show, std::string_view name) {
  const BehaviorTypes built_in;
  const auto is = [&](std::string_view type) {
    return type == name ? fmt::format("'{}' is", name) : fmt::format("'{}' means '{}', which is", name, type);
  };
  if (const auto type = built_in.find(name)) return is(type->name) + " a built-in behavior type";
  const std::string found = ScriptFiles((show / "scripts" / "scene.lua").string(), data_dir()).find_behavior(name);
  if (found.empty()) return {};
  const std::string type = fs::path(found).stem().string();
  std::error_code fault;
  const bool of_the_show = fs::equivalent(fs::path(found).parent_path(), show / "behaviors_lua", fault);
  if (of_the_show) return type == name ? "" : fmt::format("{} there already: {}", is(type), found);
  constexpr std::string_view kTwin = "lua_";
  if (type.starts_with(kTwin) && built_in.find(type.substr(kTwin.size())) != nullptr) {
    return fmt::format("{} a behavior that comes with Limber, and scenes count on it: {}", is(type), found);
  }
  print_notice("new: note: in this show it takes the place of {}", printable(found));
  return {};
}

int new_file(const NewCommand& command) {
  const bool scene = command.what == NewCommand::What::scene;
  const std::string_view kind = scene ? "scene" : "behavior";
  std::string name = command.name;
  if (name.ends_with(".lua")) name.resize(name.size() - 4);
  if (!good_name(name)) {
    const std::string near = nearest_good_name(name);
    return fail(kUsage,
                fmt::format("new: '{}' can't be a {}'s name: it has small letters, digits and _, begins with a "
                            "letter, and is up to {} long{}",
                            command.name, kind, kMostName, near.empty() ? "" : fmt::format("; such as '{}'", near)));
  }
  const fs::path show = show_folder();
  if (show.empty()) {
    return fail(
        kInput,
        "new: there is no show here: go into one (a folder that holds scripts/), or make one: limber new show DIR");
  }
  if (!scene) {
    if (const std::string why = taken_type(show, name); !why.empty())
      return fail(kInput, "new: " + why +
                              "; choose another name (case, underscores and a trailing 'behavior' make no difference)");
  }
  const EmbeddedFile* const text = find_embedded(template_files(), scene ? "scene.lua" : "behavior.lua");
  LIMBER_CHECK(text != nullptr);
  const fs::path path = show / (scene ? "scripts" : "behaviors_lua") / (name + ".lua");
  if (const int code = write_and_say(path, filled(text->text, name)); code != kFine) return code;
  if (scene) {
    print_result("\nNext:  {} play {}\n", program_command(), shell_word(path.string()));
  } else {
    print_result("\nNext:  in a scene, body:add_behavior(\"{0}\", \"my_{0}\")\n", name);
  }
  return kFine;
}

}  // namespace

int new_command(const NewCommand& command) {
  return command.what == NewCommand::What::show ? new_show(command.name) : new_file(command);
}

}  // namespace limber
