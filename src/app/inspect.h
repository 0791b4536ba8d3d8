// `limber inspect`: what the importer makes of a URDF file, as a table or as JSON.
#pragma once

#include <string>
#include <vector>

#include "model/body_model.h"

namespace limber {

/// Prints links, joints and problems to stdout; a file that holds no body is said on stderr. Returns the exit code:
/// 0 when there is a body, with whatever problems, else 1. [main]
int inspect_command(const std::string& path, bool json, const std::vector<std::string>& package_paths);

/// The same as text: the JSON of product.md, indented, or the table for people. [any]
std::string inspect_json(const BodyModel& model);
std::string inspect_table(const BodyModel& model);

}  // namespace limber
