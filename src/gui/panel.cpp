// The list that panels put themselves into.
#include "gui/panel.h"

#include <algorithm>
#include <tuple>

namespace limber {

namespace {

std::vector<PanelKind>& registered_panels() {
  static std::vector<PanelKind> kinds;
  return kinds;
}

}  // namespace

bool register_panel(const PanelKind& kind) {
  registered_panels().push_back(kind);
  return true;
}

std::vector<PanelKind> panel_kinds() {
  std::vector<PanelKind> kinds = registered_panels();
  std::sort(kinds.begin(), kinds.end(), [](const PanelKind& a, const PanelKind& b) {
    return std::tie(a.wide, a.order, a.name) < std::tie(b.wide, b.order, b.name);
  });
  return kinds;
}

}  // namespace limber
