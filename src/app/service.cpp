// Units of the user's service manager, as files.
#include "app/service.h"

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
#include "app/service_unit.h"
#include "base/output.h"
#include "base/system/executable_path.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = "limber-";
constexpr std::string_view kSuffix = ".service";

std::string unit_file(std::string_view name) {
  return fmt::format("{}/{}{}{}", service_folder(), kPrefix, name, kSuffix);
}

bool is_valid_name(std::string_view name) { return !name.empty() && name.size() <= 200 && service_name(name) == name; }

enum class Owner : std::uint8_t { none, limber, other };

// whose the file is, by its first line
Owner owner_of(const std::string& file) {
  const std::optional<system::FileStatus> status = system::link_status(file);
  if (!status) return errno == ENOENT || errno == ENOTDIR ? Owner::none : Owner::other;
  if (!status->file) return Owner::other;
  std::ifstream in(file);
  std::string line;
  return std::getline(in, line) && line == kServiceMark ? Owner::limber : Owner::other;
}

int not_ours(const std::string& file) {
  return fail(kInput, fmt::format("{} was not written by `limber service install` and stays as it is. Move it away, or "
                                  "choose another name: limber service install --name NAME",
                                  file));
}

// with a name of its own first, so that no half of a unit is ever read
Result<void> write_unit(const std::string& file, std::string_view text) {
  std::error_code fault;
  fs::create_directories(fs::path(file).parent_path(), fault);
  if (fault) return Error{fault.message()};
  const std::string fresh = fmt::format("{}.{}.new", file, system::process_id());
  if (Result<void> written = system::write_whole(fresh, text, 0644); !written) {
    (void)system::remove_file(fresh);
    return written;
  }
  fs::rename(fresh, file, fault);
  if (fault) return Error{fault.message()};
  system::sync_folder(file);
  return {};
}

std::string missing_meaning(const PlayOptions& play) {
  if (play.fast) return "--fast is for batches; a service plays in real time";
  if (play.picture.offline()) return "--render and --screenshot are for batches; a service plays in real time";
  return {};
}

// a program that systemd starts plays on while another has a port, and tries it again
std::vector<std::string> words_of_service(const ServiceCommand& command) {
  std::vector<std::string> words = command.words;
  if (!command.play.osc_optional) words.emplace_back("--osc-optional");
  return words;
}

int install(const ServiceCommand& command) {
  if (const std::string why = missing_meaning(command.play); !why.empty()) return fail(kUsage, why);
  if (service_folder().empty()) return fail(kMachine, "HOME is not set: there is no folder for units");
  std::vector<std::string> looked;
  const bool replays = !command.play.replay.empty();
  const std::string& scene = replays ? command.play.replay : command.play.scene;
  if (!replays && find_scene(scene, looked).empty()) return fail(kInput, no_scene(scene, looked));
  const std::string name = command.name.empty() ? service_name(scene) : command.name;
  if (!is_valid_name(name))
    return fail(kUsage, fmt::format("--name '{}': letters, digits, _ and - only", printable(name)));
  std::error_code fault;
  const ServiceUnit unit{.scene = scene,
                         .name = fmt::format("{}{}", kPrefix, name),
                         .program = system::executable_path(),
                         .folder = fs::current_path(fault).string(),
                         .words = words_of_service(command),
                         .window = !command.play.picture.headless};
  if (fault || unit.program.empty())
    return fail(kMachine, "the system doesn't tell where the program or the folder is");
  const Result<std::string> text = service_unit_text(unit);
  if (!text) return fail(kInput, text.error());
  const std::string file = unit_file(name);
  if (!command.print && owner_of(file) == Owner::other) return not_ours(file);
  if (!command.print) {
    if (const Result<void> written = write_unit(file, *text); !written)
      return fail(kMachine, fmt::format("{} can't be written: {}", file, written.error()));
  }
  print_result("{}", *text);
  if (command.print) return kFine;
  print_notice("written: {}", file);
  print_notice("systemctl --user daemon-reload && systemctl --user enable --now {}", unit.name);
  if (!unit.window) print_notice("without anybody logged in, too: loginctl enable-linger");
  return kFine;
}

std::vector<std::string> installed_names() {
  std::vector<std::string> names;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(service_folder(), fault)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(kPrefix) || !file.ends_with(kSuffix) || owner_of(entry.path().string()) != Owner::limber)
      continue;
    names.push_back(file.substr(kPrefix.size(), file.size() - kPrefix.size() - kSuffix.size()));
  }
  std::ranges::sort(names);
  return names;
}

// links by which `systemctl enable` starts it with a target
void remove_links(const std::string& name) {
  for (const char* target : {"default.target", "graphical-session.target"}) {
    const std::string link = fmt::format("{}/{}.wants/{}{}{}", service_folder(), target, kPrefix, name, kSuffix);
    std::error_code fault;
    if (fs::is_symlink(link, fault)) (void)system::remove_file(link);
  }
}

int remove(const ServiceCommand& command) {
  const std::vector<std::string> names = installed_names();
  std::string name = command.name;
  if (name.empty()) {
    if (names.empty()) return fail(kInput, fmt::format("no service is installed in {}", service_folder()));
    if (names.size() > 1)
      return fail(kInput, fmt::format("several services are installed: {}. Write limber service remove NAME",
                                      fmt::join(names, ", ")));
    name = names.front();
  }
  if (!is_valid_name(name))
    return fail(kUsage, fmt::format("'{}' is no name of a service: letters, digits, _ and - only", printable(name)));
  const std::string file = unit_file(name);
  const Owner owner = owner_of(file);
  if (owner == Owner::none)
    return fail(kInput, fmt::format("there is no {}{}", file,
                                    names.empty() ? "" : fmt::format("; there are: {}", fmt::join(names, ", "))));
  if (owner == Owner::other) return not_ours(file);
  if (!system::remove_file(file))
    return fail(kMachine, fmt::format("{} can't be removed: {}", file, std::generic_category().message(errno)));
  remove_links(name);
  print_notice("removed: {}", file);
  print_notice("systemctl --user stop {0}{1}; systemctl --user daemon-reload", kPrefix, name);
  return kFine;
}

}  // namespace

std::string service_folder() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && config[0] == '/') return std::string(config) + "/systemd/user";
  const char* const home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.config/systemd/user" : "";
}

int service_command(const ServiceCommand& command) {
  return command.what == ServiceCommand::What::install ? install(command) : remove(command);
}

}  // namespace limber
