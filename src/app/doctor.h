// `limber doctor`: what works on this machine, and what to do about what does not.
#pragma once

#include <string>

namespace limber {

struct DoctorCommand {
  std::string osc_in = "9003";  ///< As of `play`: where OSC would come in.
  std::string query;            ///< As of `play`; empty: under the number of `osc_in`.
  std::string gl;               ///< As of `play`.
};

/// Prints one line a finding; returns 0, or 3 when something that playing needs is missing. [main]
int doctor_command(const DoctorCommand& command);

}  // namespace limber
