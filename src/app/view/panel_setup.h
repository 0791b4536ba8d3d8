// Collects the panel's inputs from the app: settings, behavior types, console history, clipboard.
#pragma once

#include "ui/panel/gui.h"
#include "ui/render/camera.h"
#include "ui/render/gl.h"

namespace limber::app {

class ShownModels;
class Window;

/// Returns the part of a view of this size that the panel doesn't cover. [main]
render::FreeArea free_part(const panel::Gui& gui, int width, int height);

/// Returns the options of the panel. `window`: provides the clipboard and must outlive the panel; null: no clipboard.
/// `api`: OpenGL kind of the context that draws the panel. `models`: saves the scene of a model, and must outlive the
/// panel; null: no scene can be saved. [main]
panel::GuiOptions panel_options(Window* window, render::GlApi api, const ShownModels* models = nullptr);

}  // namespace limber::app
