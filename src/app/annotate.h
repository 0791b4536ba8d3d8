// `limber annotate`: definitions of all that scripts see, for editors.
#pragma once

#include <string>

namespace limber {

/// Writes them into the file, or to stdout when its name is empty. Returns the exit code. [main]
int annotate_command(const std::string& file);

/// The text. [main]
std::string annotations_text();

}  // namespace limber
