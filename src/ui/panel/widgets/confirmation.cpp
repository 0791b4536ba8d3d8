// Confirmation: a small window in the middle of the screen. The show continues meanwhile.
#include "ui/panel/widgets/confirmation.h"

#include <utility>

#include <imgui.h>

namespace limber::panel {

namespace {

// Without keyboard navigation, because Enter and Escape have a fixed meaning.
constexpr ImGuiWindowFlags kWindow = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav;

void confirm(GuiContext& context) {
  auto confirmation = std::exchange(context.requests.confirmation, std::nullopt);
  if (!confirmation) return;
  if (confirmation->action) return confirmation->action();
  context.send(std::move(confirmation->message));
}

}  // namespace

void draw_confirmation(GuiContext& context) {
  if (!context.requests.confirmation) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(1);
  bool confirmed = false;
  bool canceled = false;
  if (ImGui::Begin("##confirmation", nullptr, kWindow)) {
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(context.requests.confirmation->question.c_str());
    context.names.add("confirmation.question");
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    confirmed = ImGui::Button(context.requests.confirmation->verb.c_str());
    context.names.add("confirmation.confirm");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Enter");
    ImGui::SameLine();
    canceled = ImGui::Button("Cancel");
    context.names.add("confirmation.cancel");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Escape");
  }
  ImGui::End();
  if (confirmed) confirm(context);
  if (canceled) context.requests.confirmation.reset();
}

bool handle_confirmation_key(GuiContext& context, const KeyPress& press) {
  if (!context.requests.confirmation || press.mods != KeyMods{}) return false;
  if (press.key == GuiKey::enter) {
    confirm(context);
  } else if (press.key == GuiKey::escape) {
    context.requests.confirmation.reset();
  } else {
    return false;
  }
  return true;
}

}  // namespace limber::panel
