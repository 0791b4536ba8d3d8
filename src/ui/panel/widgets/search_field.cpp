// An input field with an icon.
#include "ui/panel/widgets/search_field.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"

namespace limber {

bool search_field(PanelContext& context, const char* name, const char* hint, std::string& text, float width) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float icon_width = ImGui::GetFontSize() * 1.25F;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {style.FramePadding.x + icon_width, style.FramePadding.y});
  ImGui::SetNextItemWidth(width);
  ImGui::PushID(name);
  const bool changed = ImGui::InputTextWithHint("##search", hint, &text, ImGuiInputTextFlags_AutoSelectAll);
  ImGui::PopID();
  ImGui::PopStyleVar();
  context.names.add(name);
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(Icon::search, low.x + style.FramePadding.x + icon_width * 0.35F, low.y + ImGui::GetFrameHeight() / 2,
            ImGui::GetFontSize() * 0.36F, packed_color(Tone::secondary));
  return changed;
}

}  // namespace limber
