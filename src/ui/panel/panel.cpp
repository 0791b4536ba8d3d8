// The registry of panels, and the rows of the top panel.
#include "ui/panel/panel.h"

#include <algorithm>
#include <tuple>

#include <imgui.h>

#include "ui/panel/imgui/imgui_versions.h"

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

float top_row_y(const GuiContext& context, int row) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float height = imgui::font_height(*context.fonts.code) + 2 * style.FramePadding.y + style.ItemSpacing.y;
  return style.WindowPadding.y + static_cast<float>(row) * height;
}

std::vector<PanelType> panel_types() {
  std::vector<PanelType> types = registered_panels();
  std::sort(types.begin(), types.end(), [](const PanelType& a, const PanelType& b) {
    return std::tie(a.wide_slot, a.order, a.name) < std::tie(b.wide_slot, b.order, b.name);
  });
  return types;
}

}  // namespace limber::panel
