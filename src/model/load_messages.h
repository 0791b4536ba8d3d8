// Messages for the log about a model that was loaded.
#pragma once

#include <string>
#include <vector>

#include "model/body_model.h"

namespace limber {

/// One line for each kind of warning and error of a model: "file:line: text. cure", with the number of further problems
/// of that kind (which differ only in names and numbers). Notes are left to `limber inspect`. [any]
std::vector<std::string> load_messages(const BodyModel& model);

}  // namespace limber
