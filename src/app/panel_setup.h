// What the panel gets from the app: settings, kinds of behaviours, the console's history, the clipboard.
#pragma once

#include "gui/gui.h"

namespace limber {

class Window;

/// `window`: whose clipboard it uses; null: none. It outlives the panel. [main]
GuiOptions panel_options(Window* window);

}  // namespace limber
