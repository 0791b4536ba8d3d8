// Manages units of the user's service manager as files.
#include "app/service/service.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/exit_code.h"
#include "app/paths.h"
#include "app/service/service_unit.h"
#include "app/viewer/played_file.h"
#include "base/log/output.h"
#include "base/system/executable_path.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber::app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = "limber-";
constexpr std::string_view kSuffix = ".service";

std::string unit_file(std::string_view name) {
  return fmt::format("{}/{}{}{}", service_folder(), kPrefix, name, kSuffix);
}

bool is_valid_name(std::string_view name) { return !name.empty() && name.size() <= 200 && service_name(name) == name; }

enum class Owner : std::uint8_t { none, limber, other };

// determines from the first line which program wrote the file
Owner owner_of(const std::string& file) {
  const std::optional<system::FileStatus> status = system::link_status(file);
  if (!status) return errno == ENOENT || errno == ENOTDIR ? Owner::none : Owner::other;
  if (!status->file) return Owner::other;
  std::ifstream in(file);
  std::string line;
  return std::getline(in, line) && line == kServiceHeader ? Owner::limber : Owner::other;
}

int fail_not_ours(const std::string& file) {
  return fail(kInputError,
              fmt::format("{} was not written by `limber service install` and is not changed. Move it away, or "
                          "choose another name: limber service install --name NAME",
                          file));
}

// writes a temporary file first, so that no incomplete unit is ever read
Result<void> write_unit(const std::string& file, std::string_view text) {
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  if (error) return Error{error.message()};
  const std::string temporary = fmt::format("{}.{}.new", file, system::process_id());
  if (Result<void> written = system::replace_file(temporary, text, 0644); !written) {
    (void)system::remove_file(temporary);
    return written;
  }
  fs::rename(temporary, file, error);
  if (error) return Error{error.message()};
  system::sync_folder(file);
  return {};
}

std::string conflicting_option(const PlayOptions& play) {
  if (play.fast) return "--fast is for batch runs; a service plays in real time";
  if (play.display.offline()) return "--render and --screenshot are for batch runs; a service plays in real time";
  if (!play.save_scene.file.empty()) return "--save-scene writes a scene and ends; a service plays";
  return {};
}

// a service keeps playing while a port is in use, and retries it
std::vector<std::string> words_of_service(const ServiceCommand& command) {
  std::vector<std::string> words = command.words;
  if (!command.play.network.osc_optional) words.emplace_back("--osc-optional");
  return words;
}

int install(const ServiceCommand& command) {
  if (const std::string reason = conflicting_option(command.play); !reason.empty()) return fail(kUsageError, reason);
  if (service_folder().empty()) return fail(kMachineError, "HOME is not set: there is no folder for units");
  const bool replays = !command.play.take.replay.empty();
  const std::string& scene = replays ? command.play.take.replay : command.play.scene;
  if (!replays) {
    if (const Result<PlayedFile> played = find_played(scene, command.play.package_paths, command.play.root); !played)
      return fail(kInputError, played.error());
  }
  const std::string name = command.name.empty() ? service_name(scene) : command.name;
  if (!is_valid_name(name))
    return fail(kUsageError, fmt::format("--name '{}': use only letters, digits, _ and -", printable(name)));
  std::error_code error;
  const ServiceUnit unit{.scene = scene,
                         .name = fmt::format("{}{}", kPrefix, name),
                         .program = system::executable_path(),
                         .folder = fs::current_path(error).string(),
                         .words = words_of_service(command),
                         .window = !command.play.display.headless};
  if (error || unit.program.empty())
    return fail(kMachineError, "the path of the program or the current folder is unknown");
  const Result<std::string> text = service_unit_text(unit);
  if (!text) return fail(kInputError, text.error());
  const std::string file = unit_file(name);
  if (command.print) {
    print_result("{}", *text);
    return kSuccess;
  }
  if (owner_of(file) == Owner::other) return fail_not_ours(file);
  if (const Result<void> written = write_unit(file, *text); !written)
    return fail(kMachineError, fmt::format("{} can't be written: {}", file, written.error()));
  print_result("{}", *text);
  print_notice("written: {}", file);
  print_notice("systemctl --user daemon-reload && systemctl --user enable --now {}", unit.name);
  if (!unit.window) print_notice("to start it without a login: loginctl enable-linger");
  return kSuccess;
}

std::vector<std::string> installed_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(service_folder(), error)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(kPrefix) || !file.ends_with(kSuffix) || owner_of(entry.path().string()) != Owner::limber)
      continue;
    names.push_back(file.substr(kPrefix.size(), file.size() - kPrefix.size() - kSuffix.size()));
  }
  std::ranges::sort(names);
  return names;
}

// removes the links that `systemctl enable` has created
void remove_links(const std::string& name) {
  for (const char* target : {"default.target", "graphical-session.target"}) {
    const std::string link = fmt::format("{}/{}.wants/{}{}{}", service_folder(), target, kPrefix, name, kSuffix);
    std::error_code error;
    if (fs::is_symlink(link, error)) (void)system::remove_file(link);
  }
}

int remove(const ServiceCommand& command) {
  const std::vector<std::string> names = installed_names();
  std::string name = command.name;
  if (name.empty()) {
    if (names.empty()) return fail(kInputError, fmt::format("no service is installed in {}", service_folder()));
    if (names.size() > 1)
      return fail(kInputError, fmt::format("several services are installed: {}. Write limber service remove NAME",
                                           fmt::join(names, ", ")));
    name = names.front();
  }
  if (!is_valid_name(name))
    return fail(kUsageError,
                fmt::format("'{}' is not a valid service name: use only letters, digits, _ and -", printable(name)));
  const std::string file = unit_file(name);
  const Owner owner = owner_of(file);
  if (owner == Owner::none)
    return fail(kInputError, fmt::format("{} not found{}", file,
                                         names.empty() ? "" : fmt::format("; installed: {}", fmt::join(names, ", "))));
  if (owner == Owner::other) return fail_not_ours(file);
  if (!system::remove_file(file))
    return fail(kMachineError, fmt::format("{} can't be removed: {}", file, std::generic_category().message(errno)));
  remove_links(name);
  print_notice("removed: {}", file);
  print_notice("systemctl --user stop {0}{1}; systemctl --user daemon-reload", kPrefix, name);
  return kSuccess;
}

}  // namespace

std::string service_folder() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && config[0] == '/') return std::string(config) + "/systemd/user";
  const char* const home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.config/systemd/user" : "";
}

int service_command(const ServiceCommand& command) {
  return command.action == ServiceCommand::Action::install ? install(command) : remove(command);
}

}  // namespace limber::app
