// `limber inspect`: prints the result of importing a URDF file, as a table or as JSON.
#pragma once

#include <string>
#include <vector>

#include "model/body_model.h"

namespace limber {

/// Prints links, joints and problems to stdout; if the file contains no body, an error to stderr. Returns the exit
/// code: 0 if there is a body, even with problems, else 1. [main]
int inspect_command(const std::string& path, bool json, const std::vector<std::string>& package_paths);

/// Return the same as text: indented JSON, or a table for people. [any]
std::string inspect_json(const BodyModel& model);
std::string inspect_table(const BodyModel& model);

}  // namespace limber
