// `limber service`: installs shows as services that systemd starts, monitors and restarts.
#pragma once

#include <string>
#include <vector>

#include "app/show/play.h"

namespace limber::app {

/// Arguments of `service`.
struct ServiceCommand {
  enum class Action : std::uint8_t { install, remove };
  Action action = Action::install;
  std::string name;                ///< Empty: named after the scene; for `remove`: the only installed one.
  bool print = false;              ///< Print the unit instead of writing it.
  std::vector<std::string> words;  ///< For `install`: arguments of `limber play`, as typed.
  PlayOptions play;                ///< The same arguments, parsed.
};

/// Returns the folder of this user's units; empty if there is no home folder.
std::string service_folder();

/// Writes or removes a unit. Returns the exit code. [main]
int service_command(const ServiceCommand& command);

}  // namespace limber::app
