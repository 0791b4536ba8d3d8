// `limber doctor`: checks this machine and says how to fix each problem.
#pragma once

#include <string>

namespace limber {

/// Options of `doctor`.
struct DoctorCommand {
  std::string osc_in = "9003";  ///< OSC input address, as in `play`.
  std::string query;            ///< OSCQuery address, as in `play`; empty: the port number of `osc_in`.
  std::string gl;               ///< Kind of OpenGL, as in `play`.
};

/// Prints one line for each check. Returns 0, or 3 if something that `play` needs is missing. [main]
int doctor_command(const DoctorCommand& command);

}  // namespace limber
