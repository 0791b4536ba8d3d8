// Time, the second row of the top bar: its speed, how far it can go back, the take, and why a message was refused.
#include <algorithm>

#include <fmt/format.h>
#include <imgui_internal.h>

#include "base/text.h"
#include "gui/clock_text.h"
#include "gui/history_bar.h"
#include "gui/icons.h"
#include "gui/imgui_versions.h"
#include "gui/panel.h"
#include "gui/property_widget.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr std::size_t kMostOfName = 20;  // bytes

class TimePanel : public Panel {
 public:
  void hear(Desk& desk) override {
    if (desk.image == nullptr) return;
    const TakeState take = desk.take();
    if (!take.recorded() && take_.recorded())
      desk.say(fmt::format("the take '{}' has ended: {}", take_.name, clock_text(take_.seconds)));
    if (!take.plays && take_.plays) desk.say(fmt::format("the take '{}' is over: the show is yours", take_.name));
    take_ = take;
  }

  void draw(Desk& desk) override {
    const auto s = static_cast<float>(desk.scale);
    const ImGuiStyle& style = ImGui::GetStyle();
    const bool compact = ImGui::GetWindowWidth() < static_cast<float>(kCompactBelow) * s * 0.95F;
    const float rows = compact ? 2 : 1;  // above this one
    const float row = imgui::font_height(*desk.fonts.code) + 2 * style.FramePadding.y + style.ItemSpacing.y;
    ImGui::SetCursorPos({style.WindowPadding.x, style.WindowPadding.y + rows * row});
    speed(desk, s);
    if (take_.replays) {
      replay(desk, compact, s);
    } else {
      past(desk, (compact ? 120 : 200) * s);
      if (take_.recorded()) {
        recording(desk);
      } else {
        play_take(desk);
      }
    }
    refusal(desk);
  }

 private:
  static void speed(Desk& desk, float s) {
    const auto speed = desk.find("/physics/sim/speed");
    if (!speed) return;
    ImGui::PushID("speed");
    property_widget(desk, *speed, 74 * s);
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("\u00d7 time");
    ImGui::SameLine();
    ImGui::PushFont(desk.fonts.code);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("tick %-7llu", static_cast<unsigned long long>(desk.now->tick));
    desk.names.note("transport.tick");
    ImGui::PopFont();
    ImGui::SameLine();
  }

  void past(Desk& desk, float width) {
    if (icon_button(desk.names, "transport.rewind", Icon::rewind,
                    fmt::format("{} s back (Shift+,)", kRewindSeconds).c_str()))
      desk.rewind(kRewindSeconds);
    ImGui::SameLine(0, 4 * static_cast<float>(desk.scale));
    const PastRange past{desk.number("/physics/sim/history"), desk.number("/transport/rewindable")};
    const double back = history_bar("##past", past, width, held_);
    desk.names.note("transport.past");
    if (back > 0) desk.rewind(back);
    if (ImGui::IsItemHovered() && held_ == 0)
      ImGui::SetTooltip("time can go back %.1f s, %.0f s are kept: press or drag to a moment and let go",
                        past.rewindable, past.kept);
    ImGui::SameLine();
  }

  static void play_take(Desk& desk) {
    if (icon_button(desk.names, "take.play", Icon::play, "the newest take plays (Ctrl+Shift+R)")) desk.play_take();
    ImGui::SameLine();
  }

  // a word and a sign beside the colour
  void recording(Desk& desk) const {
    const float size = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    draw_icon(Icon::record, at.x + size * 0.35F, at.y + size / 2, size * 0.26F, packed(Tone::red));
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + size * 0.8F);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(
        fmt::format("REC {} {}", shortened(take_.name, kMostOfName), clock_text(take_.seconds)).c_str());
    desk.names.note("take.text");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("the take '%s' is being recorded", take_.name.c_str());
    ImGui::SameLine();
  }

  // where the replay is of how long the take is
  void replay(Desk& desk, bool compact, float s) const {
    if (take_.plays) {
      if (icon_button(desk.names, "take.stop", Icon::stop, "the show goes on from here, by hand (Ctrl+Shift+R)"))
        desk.play_take();
      ImGui::SameLine();
    }
    const float width = (compact ? 160 : 260) * s;
    const float high = ImGui::GetFrameHeight();
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 end{low.x + width, low.y + high};
    ImGui::Dummy({width, high});
    desk.names.note("take.line");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("the take '%s' is replayed", take_.name.c_str());
    const float rounding = ImGui::GetStyle().FrameRounding;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, end, packed(Tone::field), rounding);
    const double part = take_.whole > 0 ? std::clamp(take_.seconds / take_.whole, 0.0, 1.0) : 0;
    list.AddRectFilled(low, {low.x + width * static_cast<float>(part), end.y}, packed(Tone::fill), rounding);
    const std::string clock = fmt::format("{} / {}", clock_text(take_.seconds), clock_text(take_.whole));
    ImGui::RenderTextClipped(low, end, clock.c_str(), clock.c_str() + clock.size(), nullptr, {0.5F, 0.5F});
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    const char* const hands = take_.plays ? "hands wait" : "hands are refused";
    const std::string words =
        compact ? hands : fmt::format("replay of {}: {}", shortened(take_.name, kMostOfName), hands);
    ImGui::TextUnformatted(words.c_str());
    desk.names.note("take.text");
    ImGui::SameLine();
  }

  // to the end of the row; what has no room is in the tooltip
  static void refusal(Desk& desk) {
    if (desk.clock >= desk.refusal_until) return;
    const float high = ImGui::GetFrameHeight();
    const float width = ImGui::GetContentRegionAvail().x;
    if (width < high) return;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("##refusal", {width, high})) desk.copied(desk.refusal);
    desk.names.note("refusal");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("refused: %s", desk.refusal.c_str());
    draw_icon(Icon::warning, low.x + high * 0.45F, low.y + high / 2, high * 0.3F, packed(Tone::red));
    const float top = low.y + ImGui::GetStyle().FramePadding.y;
    ImGui::PushStyleColor(ImGuiCol_Text, packed(Tone::red));
    imgui::text_ellipsis({low.x + high, top}, {low.x + width, low.y + high}, desk.refusal);
    ImGui::PopStyleColor();
  }

  TakeState take_;
  double held_ = 0;  // s back, by a hand at the bar
};

[[maybe_unused]] const bool kTimePanel =
    panel<TimePanel>({.name = "time", .title = "", .wide = Slot::top, .compact = Slot::top, .order = 3});

}  // namespace
}  // namespace limber
