// Confirmation: a question that is asked before a message is sent that can't be undone.
#pragma once

#include "ui/panel/gui_context.h"
#include "ui/panel/imgui/input.h"

namespace limber::panel {

/// Draws the question of PanelRequests::confirmation, if there is one, with its two buttons. Call it outside of
/// windows.
void draw_confirmation(GuiContext& context);

/// Handles a key press while a question is asked: Enter sends the message, Escape cancels. Returns false for other
/// keys.
bool handle_confirmation_key(GuiContext& context, const KeyPress& press);

}  // namespace limber::panel
