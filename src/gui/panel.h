// A panel: one file of this folder, which registers itself. What it shows comes from the desk, what hands do goes
// there.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gui/desk.h"
#include "gui/layout.h"

namespace limber {

class Panel {
 public:
  Panel() = default;
  virtual ~Panel() = default;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  /// Into the window that is begun.
  virtual void draw(Desk& desk) = 0;
  /// Each frame, seen or not, before anything is drawn: what must not be missed.
  virtual void hear(Desk& desk) { (void)desk; }
  /// Behind its title: a count, say.
  virtual std::string badge(const Desk& desk) const {
    (void)desk;
    return {};
  }
};

struct PanelKind {
  std::string_view name;   ///< Of its file: panel_<name>.cpp.
  std::string_view title;  ///< Empty: none is shown.
  Slot wide = Slot::top;
  Slot compact = Slot::top;
  int order = 0;  ///< Within a slot.
  std::unique_ptr<Panel> (*make)() = nullptr;
};

/// All that have registered, by slot and order. [main]
std::vector<PanelKind> panel_kinds();
bool register_panel(const PanelKind& kind);

/// `const bool kRegistered = panel<P>({…})` in a panel's file.
template <class P>
bool panel(PanelKind kind) {
  kind.make = [] { return std::unique_ptr<Panel>(std::make_unique<P>()); };
  return register_panel(kind);
}

}  // namespace limber
