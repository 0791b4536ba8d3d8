// A button without a face of its own, and the face.
#include "gui/history_bar.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "gui/theme.h"

namespace limber {

namespace {

constexpr double kLeastBack = 0.05;  // s; a hand that is nearer to now has changed its mind

void draw_history(const PastRange& past, double held, bool lit) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto at = [&](double back) {
    const double part = past.kept > 0 ? std::clamp(back / past.kept, 0.0, 1.0) : 0;
    return high.x - (high.x - low.x) * static_cast<float>(part);
  };
  list.AddRectFilled(low, high, packed(lit ? Tone::hover : Tone::field), style.FrameRounding);
  if (past.rewindable > 0)
    list.AddRectFilled({at(past.rewindable), low.y}, high, packed(Tone::fill), style.FrameRounding);
  if (held > 0) {
    const float mark = std::max(style.GrabMinSize * 0.5F, 1.0F);
    list.AddRectFilled({at(held) - mark / 2, low.y + 1}, {at(held) + mark / 2, high.y - 1}, packed(Tone::accent));
  }
  std::string text = fmt::format("{:.1f} s back", past.rewindable);
  if (past.kept <= 0) text = "no history";
  if (held > 0) text = fmt::format("-{:.1f} s", held);
  ImGui::RenderTextClipped(low, high, text.c_str(), text.c_str() + text.size(), nullptr, {0.5F, 0.5F});
}

}  // namespace

double history_bar(const char* id, const PastRange& past, float width, double& held) {
  ImGui::InvisibleButton(id, {width, ImGui::GetFrameHeight()});
  const bool dragged = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (dragged) {
    const double place = (ImGui::GetItemRectMax().x - ImGui::GetMousePos().x) / width;
    held = std::clamp(place * past.kept, 0.0, std::max(past.rewindable, 0.0));
  }
  double back = 0;
  if (!ImGui::IsItemActive()) back = std::exchange(held, 0);
  draw_history(past, held, dragged || ImGui::IsItemHovered());
  return back > kLeastBack ? back : 0;
}

}  // namespace limber
