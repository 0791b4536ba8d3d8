// The registry of panels.
#include "ui/panel/panel.h"

#include <algorithm>
#include <tuple>

namespace limber::panel {

namespace {

std::vector<PanelType>& registered_panels() {
  static std::vector<PanelType> types;
  return types;
}

}  // namespace

bool register_panel(const PanelType& type) {
  registered_panels().push_back(type);
  return true;
}

std::vector<PanelType> panel_types() {
  std::vector<PanelType> types = registered_panels();
  std::sort(types.begin(), types.end(), [](const PanelType& a, const PanelType& b) {
    return std::tie(a.wide_slot, a.order, a.name) < std::tie(b.wide_slot, b.order, b.name);
  });
  return types;
}

}  // namespace limber::panel
