// Log messages about the problems of a loaded model.
#pragma once

#include <string>
#include <vector>

#include "model/body_model.h"

namespace limber {

/// Returns one line for each kind of warning and error: "file:line: text. fix", with the number of further problems of
/// that kind, which differ only in names and numbers. Notes are omitted; `limber inspect` prints them. [any]
std::vector<std::string> load_messages(const BodyModel& model);

}  // namespace limber
