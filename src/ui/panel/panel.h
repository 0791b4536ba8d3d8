// Panel: the interface of panels. Each panel is one file in panels/, which registers it. A panel reads its data from
// the context and sends user input to it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ui/panel/gui_context.h"
#include "ui/panel/layout.h"

namespace limber::panel {

/// Base class of panels. [main]
class Panel {
 public:
  Panel() = default;
  virtual ~Panel() = default;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  /// Draws into the current window.
  virtual void draw(GuiContext& context) = 0;
  /// Called in each frame before drawing, even if the panel is hidden; handles events that must not be missed.
  virtual void update(GuiContext& context) { (void)context; }
  /// Text after the title, for example a count.
  virtual std::string badge(const GuiContext& context) const {
    (void)context;
    return {};
  }
};

/// Vertical position in the top panel's window of a row, from 0, in pixels.
float top_row_y(const GuiContext& context, int row);

/// A registered kind of panel, with its slot in wide and compact windows.
struct PanelType {
  std::string_view name;   ///< Its file name.
  std::string_view title;  ///< Empty: no title.
  PanelSlot wide_slot = PanelSlot::top;
  PanelSlot compact_slot = PanelSlot::top;
  int order = 0;  ///< Position within a slot.
  std::unique_ptr<Panel> (*make)() = nullptr;
};

/// All registered panels, by slot and order. [main]
std::vector<PanelType> panel_types();
bool register_panel(const PanelType& type);

/// Registers the panel class P. In the panel's file: `[[maybe_unused]] const bool kClockPanel =
/// register_panel_type<ClockPanel>({…})`, with a name that is unique in the folder.
template <class P>
bool register_panel_type(PanelType type) {
  type.make = [] { return std::unique_ptr<Panel>(std::make_unique<P>()); };
  return register_panel(type);
}

}  // namespace limber::panel
