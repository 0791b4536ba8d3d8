// Time, the second row of the top bar: speed, history, take, and the last rejected message.
#include <algorithm>

#include <fmt/format.h>
#include <imgui_internal.h>

#include "base/text.h"
#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/property_widget.h"
#include "ui/panel/widgets/time_widgets.h"

namespace limber::panel {

namespace {

constexpr std::size_t kMaxNameBytes = 20;  // longer names of takes are shortened

class TimePanel : public Panel {
 public:
  void update(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    const TakeState take = context.take_state();
    if (!take.recording() && take_.recording())
      context.show_notice(fmt::format("Take '{}' recorded: {}", take_.name, clock_text(take_.seconds)));
    if (!take.in_show && take_.in_show)
      context.show_notice(fmt::format("Take '{}' has ended; live control resumes", take_.name));
    take_ = take;
  }

  void draw(GuiContext& context) override {
    const auto s = static_cast<float>(context.scale);
    const ImGuiStyle& style = ImGui::GetStyle();
    const bool compact = ImGui::GetWindowWidth() < static_cast<float>(kCompactBelow) * s * 0.95F;
    ImGui::SetCursorPos({style.WindowPadding.x, top_row_y(context, compact ? 2 : 1)});
    draw_speed(context, s);
    if (take_.replaying) {
      draw_replay(context, compact, s);
    } else {
      draw_history(context, (compact ? 120 : 200) * s);
      if (take_.recording()) draw_recording(context);
    }
    draw_rejection(context, compact ? 0 : static_cast<float>(kMorphWidth) * s);
  }

 private:
  static void draw_speed(GuiContext& context, float s) {
    const auto speed = context.find("/physics/sim/speed");
    if (!speed) return;
    ImGui::PushID("speed");
    property_widget(context, *speed, 74 * s);
    property_menu(context, *speed);
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("\u00d7 time");
    ImGui::SameLine();
    ImGui::PushFont(context.fonts.code);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Tick %-7llu", static_cast<unsigned long long>(context.snapshot->tick));
    context.names.add("transport.tick");
    ImGui::PopFont();
    ImGui::SameLine();
  }

  void draw_history(GuiContext& context, float width) {
    if (icon_button(context.names, "transport.rewind", Icon::rewind,
                    fmt::format("Rewind {} s (Shift+,)", kRewindSeconds).c_str()))
      context.rewind(kRewindSeconds);
    ImGui::SameLine(0, 4 * static_cast<float>(context.scale));
    const HistoryRange range{context.number("/physics/sim/history"), context.number("/transport/rewindable")};
    const double back = history_bar("##history", range, width, dragged_back_);
    context.names.add("transport.history");
    if (back > 0) context.rewind(back);
    if (ImGui::IsItemHovered() && dragged_back_ == 0)
      ImGui::SetTooltip("History: %.1f s of %.0f s. Press or drag to a time and release to rewind", range.rewindable,
                        range.length);
    ImGui::SameLine();
  }

  // Draws text and an icon in addition to the color.
  void draw_recording(GuiContext& context) const {
    const float size = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    draw_icon(Icon::record, at.x + size * 0.35F, at.y + size / 2, size * 0.26F, packed_color(ThemeColor::red));
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + size * 0.8F);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(
        fmt::format("REC {} {}", shortened(take_.name, kMaxNameBytes), clock_text(take_.seconds)).c_str());
    context.names.add("take.text");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Recording take '%s'", take_.name.c_str());
    ImGui::SameLine();
  }

  // Draws the position of the replay.
  void draw_replay(GuiContext& context, bool compact, float s) const {
    if (take_.in_show) {
      if (icon_button(context.names, "take.stop", Icon::stop,
                      "Stop the take and continue live from here (Ctrl+Shift+R)"))
        context.toggle_take_playback();
      ImGui::SameLine();
    }
    const float width = (compact ? 160 : 260) * s;
    const float high = ImGui::GetFrameHeight();
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 end{low.x + width, low.y + high};
    ImGui::Dummy({width, high});
    context.names.add("take.line");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Replaying take '%s'", take_.name.c_str());
    const float rounding = ImGui::GetStyle().FrameRounding;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, end, packed_color(ThemeColor::field), rounding);
    const double part = take_.duration > 0 ? std::clamp(take_.seconds / take_.duration, 0.0, 1.0) : 0;
    list.AddRectFilled(low, {low.x + width * static_cast<float>(part), end.y}, packed_color(ThemeColor::fill),
                       rounding);
    const std::string clock = fmt::format("{} / {}", clock_text(take_.seconds), clock_text(take_.duration));
    ImGui::RenderTextClipped(low, end, clock.c_str(), clock.c_str() + clock.size(), nullptr, {0.5F, 0.5F});
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    const char* const input_text = take_.in_show ? "input paused" : "input rejected";
    const std::string text =
        compact ? input_text : fmt::format("Replay of {}: {}", shortened(take_.name, kMaxNameBytes), input_text);
    ImGui::TextUnformatted(text.c_str());
    context.names.add("take.text");
    ImGui::SameLine();
  }

  // Extends to the end of the row, of which `reserved` pixels are used by others; the tooltip shows the full text.
  static void draw_rejection(GuiContext& context, float reserved) {
    if (!context.rejection.visible(context.clock)) return;
    const float high = ImGui::GetFrameHeight();
    const float width = ImGui::GetContentRegionAvail().x - reserved;
    if (width < high) return;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("##rejection", {width, high})) context.copy_with_notice(context.rejection.text);
    context.names.add("rejection");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Rejected: %s", context.rejection.text.c_str());
    draw_icon(Icon::warning, low.x + high * 0.45F, low.y + high / 2, high * 0.3F, packed_color(ThemeColor::red));
    const float top = low.y + ImGui::GetStyle().FramePadding.y;
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(ThemeColor::red));
    imgui::text_ellipsis({low.x + high, top}, {low.x + width, low.y + high}, context.rejection.text);
    ImGui::PopStyleColor();
  }

  TakeState take_;
  double dragged_back_ = 0;  // s to rewind, while the bar is dragged
};

[[maybe_unused]] const bool kTimePanel = register_panel_type<TimePanel>(
    {.name = "time", .title = "", .wide_slot = PanelSlot::top, .compact_slot = PanelSlot::top, .order = 3});

}  // namespace
}  // namespace limber::panel
