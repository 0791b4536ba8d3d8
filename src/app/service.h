// `limber service`: shows that systemd starts, watches and restarts.
#pragma once

#include <string>
#include <vector>

#include "app/play.h"

namespace limber {

struct ServiceCommand {
  enum class What : std::uint8_t { install, remove };
  What what = What::install;
  std::string name;                ///< Empty: after the scene; of `remove`: the only one that there is.
  bool print = false;              ///< Print the unit and write nothing.
  std::vector<std::string> words;  ///< Of `install`: arguments of `limber play`, as typed.
  PlayOptions play;                ///< The same, parsed.
};

/// The folder of this user's units; empty when there is no home.
std::string service_folder();

/// Writes or removes a unit; returns the exit code. [main]
int service_command(const ServiceCommand& command);

}  // namespace limber
