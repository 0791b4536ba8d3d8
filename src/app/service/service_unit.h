// Generates the systemd unit of a show.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::app {

/// First line of each unit that this program writes. Only files with this line are replaced or removed.
inline constexpr std::string_view kServiceHeader =
    "# Written by `limber service install`, which may replace it. `limber service remove` deletes it.";

/// Contents of a unit.
struct ServiceUnit {
  std::string scene;               ///< Shown in the description.
  std::string name;                ///< "limber-NAME", without ".service".
  std::string program;             ///< Absolute path.
  std::string folder;              ///< Working directory, absolute.
  std::vector<std::string> words;  ///< Arguments of `limber play`.
  bool window = true;              ///< Start after the desktop session.
};

/// Returns the text of the unit, or an error if a path can't be written in one.
Result<std::string> service_unit_text(const ServiceUnit& unit);

/// Returns one word of a command line in a unit: quoted, with characters escaped that systemd would expand.
std::string unit_word(std::string_view text);

/// Returns the name of a show's unit without "limber-": the scene's file name reduced to letters, digits, _ and -.
std::string service_name(std::string_view scene);

}  // namespace limber::app
