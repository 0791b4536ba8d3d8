// Stores the last item's rectangle, clipped to its window.
#include "ui/panel/widgets/widget_names.h"

#include <algorithm>

#include <imgui.h>
#include <imgui_internal.h>

namespace limber::panel {

void WidgetNames::add(std::string_view name) {
  if (count_ == widgets_.size()) widgets_.emplace_back();
  NamedWidget& widget = widgets_[count_++];
  widget.name = name;
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  widget.rect = {low.x, low.y, high.x - low.x, high.y - low.y};
  const ImGuiWindow* const window = ImGui::GetCurrentWindow();
  const ImRect& clip = window->ClipRect;
  const float left = std::max(low.x, clip.Min.x);
  const float top = std::max(low.y, clip.Min.y);
  const float right = std::min(high.x, clip.Max.x);
  const float bottom = std::min(high.y, clip.Max.y);
  widget.visible = right > left && bottom > top ? PanelRect{left, top, right - left, bottom - top} : PanelRect{};
  widget.window = window->RootWindow->ID;
}

const NamedWidget* WidgetNames::find(std::string_view name) const {
  for (std::size_t i = 0; i < count_; i++) {
    if (widgets_[i].name == name) return &widgets_[i];
  }
  return nullptr;
}

}  // namespace limber::panel
