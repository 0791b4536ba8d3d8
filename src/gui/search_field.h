// A field that one searches with: a glass, a hint, what is typed.
#pragma once

#include <string>

#include "gui/desk.h"

namespace limber {

/// True: the text has become another. `name`: its id, and its name among the widgets.
bool search_field(Desk& desk, const char* name, const char* hint, std::string& text, float width);

}  // namespace limber
