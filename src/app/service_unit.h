// The text of a systemd unit that plays a show.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber {

/// The first line of each unit that this program writes. It replaces and removes no other.
inline constexpr std::string_view kServiceMark =
    "# Written by `limber service install`, which may replace it. `limber service remove` deletes it.";

struct ServiceUnit {
  std::string scene;               ///< For people.
  std::string name;                ///< "limber-NAME", without ".service".
  std::string program;             ///< Absolute path.
  std::string folder;              ///< Working directory, absolute.
  std::vector<std::string> words;  ///< Arguments of `limber play`.
  bool window = true;              ///< It waits for the desktop.
};

/// The unit. The error names what a unit can't hold.
Result<std::string> service_unit_text(const ServiceUnit& unit);

/// One word of a command line in a unit: quoted, with what systemd would expand escaped.
std::string unit_word(std::string_view text);

/// The name of a show's unit without "limber-": letters, digits, _ and - of the scene's file name.
std::string service_name(std::string_view scene);

}  // namespace limber
