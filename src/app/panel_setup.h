// What the panel gets from the app: settings, kinds of behaviours, the console's history, the clipboard.
#pragma once

#include "gui/gui.h"
#include "view/gl.h"
#include "view/lens.h"

namespace limber {

class Window;

/// What of a picture of that size the panel leaves free. [main]
FreePart free_part(const Gui& gui, int width, int height);

/// `window`: whose clipboard it uses; null: none. It outlives the panel. `api`: of the context that it is drawn in.
/// [main]
GuiOptions panel_options(Window* window, GlApi api);

}  // namespace limber
