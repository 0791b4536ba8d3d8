// `limber annotate`: writes the LuaCATS definitions of everything that scripts can use, for editors.
#pragma once

#include <string>

namespace limber {

/// Writes the definitions to `file`, or to stdout if its name is empty. Returns the exit code. [main]
int annotate_command(const std::string& file);

/// Returns the definitions as text. [main]
std::string annotations_text();

}  // namespace limber
