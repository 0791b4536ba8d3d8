// Errors: current warnings and script errors with file and line; a click copies the location.
#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/error_list.h"
#include "ui/panel/widgets/icons.h"

namespace limber::panel {

namespace {

class ErrorsPanel : public Panel {
 public:
  std::string badge(const GuiContext&) const override { return list_.count_text(); }

  void update(GuiContext& context) override {
    for (const LogLine& line : log_since(last_line_)) {
      last_line_ = line.number;
      list_.add(line);
    }
    context.errors = list_.error_count();
  }

  void draw(GuiContext& context) override {
    if (list_.entries().empty()) return ImGui::TextDisabled("No errors");
    if (ImGui::SmallButton("Clear")) list_.clear();
    context.names.add("errors.clear");
    if (!ImGui::BeginChild("##faults", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    int i = 0;
    for (auto entry = list_.entries().rbegin(); entry != list_.entries().rend(); ++entry)
      draw_line(context, *entry, i++);
    ImGui::EndChild();
  }

 private:
  static void draw_line(GuiContext& context, const ErrorEntry& entry, int i) {
    const bool error = entry.line.level == LogLevel::error;
    const std::uint32_t color = packed_color(error ? ThemeColor::red : ThemeColor::accent);
    const float sign = ImGui::GetFontSize() * 1.3F;
    ImGui::PushID(i);
    ImGui::PushFont(context.fonts.code);
    const float wrap = ImGui::GetContentRegionAvail().x - sign;
    const ImVec2 size = ImGui::CalcTextSize(entry.line.text.c_str(), nullptr, false, wrap);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##fault", false, 0, {0, size.y}))
      context.copy_with_notice(entry.location.empty() ? entry.line.text : entry.location);
    ImGui::PopFont();
    context.names.add(fmt::format("error.{}", i));
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Click to copy %s", entry.location.empty() ? "the text" : entry.location.c_str());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_icon(error ? Icon::warning : Icon::right, from.x + sign * 0.4F, from.y + ImGui::GetFontSize() * 0.55F,
              ImGui::GetFontSize() * 0.36F, color);
    list.AddText(context.fonts.code, imgui::font_height(*context.fonts.code), {from.x + sign, from.y}, color,
                 entry.line.text.c_str(), nullptr, wrap);
    ImGui::PopID();
  }

  ErrorList list_;
  std::uint64_t last_line_ = 0;
};

[[maybe_unused]] const bool kErrorsPanel = register_panel_type<ErrorsPanel>({.name = "errors",
                                                                             .title = "Errors",
                                                                             .wide_slot = PanelSlot::bottom,
                                                                             .compact_slot = PanelSlot::bottom,
                                                                             .order = 1});

}  // namespace
}  // namespace limber::panel
