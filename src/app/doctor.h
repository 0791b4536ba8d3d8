// `limber doctor`: what works on this machine, and what to do about what does not.
#pragma once

namespace limber {

/// Prints one line a finding; returns 0, or 3 when something that playing needs is missing. [main]
int doctor_command();

}  // namespace limber
