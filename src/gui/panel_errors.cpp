// Errors: what stands against the scripts, with file and line; a click copies the place.
#include <fmt/format.h>
#include <imgui.h>

#include "gui/fault_list.h"
#include "gui/icons.h"
#include "gui/imgui_versions.h"
#include "gui/panel.h"
#include "gui/theme.h"

namespace limber {

namespace {

class ErrorsPanel : public Panel {
 public:
  std::string badge(const Desk&) const override { return list_.count_text(); }

  void hear(Desk& desk) override {
    for (const LogLine& line : log_since(seen_)) {
      seen_ = line.number;
      list_.hear(line);
    }
    desk.errors = list_.errors();
  }

  void draw(Desk& desk) override {
    if (list_.faults().empty()) return ImGui::TextDisabled("all is well");
    if (ImGui::SmallButton("clear")) list_.clear();
    desk.names.note("errors.clear");
    if (!ImGui::BeginChild("##faults", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    int i = 0;
    for (auto fault = list_.faults().rbegin(); fault != list_.faults().rend(); ++fault) line(desk, *fault, i++);
    ImGui::EndChild();
  }

 private:
  static void line(Desk& desk, const Fault& fault, int i) {
    const bool error = fault.line.level == LogLevel::error;
    const std::uint32_t color = packed(error ? Tone::red : Tone::accent);
    const float sign = ImGui::GetFontSize() * 1.3F;
    ImGui::PushID(i);
    ImGui::PushFont(desk.fonts.code);
    const float wrap = ImGui::GetContentRegionAvail().x - sign;
    const ImVec2 size = ImGui::CalcTextSize(fault.line.text.c_str(), nullptr, false, wrap);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##fault", false, 0, {0, size.y}))
      desk.copied(fault.place.empty() ? fault.line.text : fault.place);
    ImGui::PopFont();
    desk.names.note(fmt::format("error.{}", i));
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("click copies %s", fault.place.empty() ? "the text" : fault.place.c_str());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_icon(error ? Icon::warning : Icon::right, from.x + sign * 0.4F, from.y + ImGui::GetFontSize() * 0.55F,
              ImGui::GetFontSize() * 0.36F, color);
    list.AddText(desk.fonts.code, imgui::font_height(*desk.fonts.code), {from.x + sign, from.y}, color,
                 fault.line.text.c_str(), nullptr, wrap);
    ImGui::PopID();
  }

  FaultList list_;
  std::uint64_t seen_ = 0;
};

[[maybe_unused]] const bool kErrorsPanel =
    panel<ErrorsPanel>({.name = "errors", .title = "Errors", .wide = Slot::below, .compact = Slot::below, .order = 1});

}  // namespace
}  // namespace limber
