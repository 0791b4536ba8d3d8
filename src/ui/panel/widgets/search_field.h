// A text field for searching, with a magnifier icon and a hint.
#pragma once

#include <string>

#include "ui/panel/panel_context.h"

namespace limber {

/// Returns true if the text has changed. `name`: its id and its widget name.
bool search_field(PanelContext& context, const char* name, const char* hint, std::string& text, float width);

}  // namespace limber
