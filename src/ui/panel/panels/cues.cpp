// Cues: the list of cues, the one that has run last, the buttons that start and pause them, and the clock.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/text.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

namespace {

/// A field of a cue that its menu edits, in the order of /cue/fields.
struct CueField {
  const char* name;
  const char* hint;
  bool is_number = false;
  std::array<const char*, 4> choices = {};  ///< The first one null: any text.
};
constexpr std::array<CueField, 8> kFields = {{
    {"name", "Its name; Enter applies a text"},
    {"preset", "Preset that it recalls; empty: none"},
    {"time", "Duration of the recall, s", true},
    {"easing", "Course of the recall", false, {"linear", "smooth", "in", "out"}},
    {"at", "Starts at once, or at the next beat or bar", false, {"now", "beat", "bar"}},
    {"when", "Address whose message starts it, if it is the next one"},
    {"follow", "Simulated seconds until the next cue starts by itself; empty: it waits for Go", true},
    {"note", "For people"},
}};

class CuesPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    const double current = context.number("/cue/current");
    return current > 0 ? fmt::format("{:.0f}", current) : "";
  }

  void draw(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    const auto handle = context.find("/cue/fields");
    const std::string_view cues = handle ? context.text(handle->ref) : std::string_view();
    draw_buttons(context, cues.empty());
    draw_clock(context);
    if (!ImGui::BeginChild("##cues", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    if (cues.empty())
      ImGui::TextDisabled("No cues: add one, or write them to a file beside the scene, SCENE.cues.json");
    const auto current = static_cast<int>(context.number("/cue/current"));
    int number = 0;
    count_ = cues.empty() ? 0 : static_cast<int>(1 + std::ranges::count(cues, '\n'));
    for (const std::string_view fields : split(cues, '\n')) {
      if (!fields.empty()) draw_cue(context, ++number, std::string(fields), current);
    }
    shown_ = current;
    ImGui::EndChild();
  }

 private:
  static void draw_button(GuiContext& context, const char* label, const char* address, const char* name,
                          const char* hint) {
    if (ImGui::Button(label)) context.send(address);
    context.names.add(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hint);
    ImGui::SameLine();
  }

  void draw_buttons(GuiContext& context, bool empty) {
    const bool paused = context.number("/cue/paused") != 0;
    ImGui::BeginDisabled(empty);
    draw_button(context, "Go", "/cue/go", "cues.go", "Start the next cue (F5)");
    draw_button(context, "Back", "/cue/back", "cues.back", "Start the cue before the last one again (Shift+F5)");
    draw_button(context, paused ? "Resume###pause" : "Pause###pause", "/cue/pause", "cues.pause",
                "Pause or resume the time until the next cue starts by itself (F6)");
    ImGui::EndDisabled();
    draw_add(context);
    const double follow = context.number("/cue/follow");
    const double waiting = context.number("/cue/waiting");
    ImGui::AlignTextToFramePadding();
    if (waiting > 0) {
      ImGui::Text("%.0f waits for its beat", waiting);
    } else if (follow > 0) {
      ImGui::Text("%s in %.1f s", paused ? "Paused: next" : "Next", follow);
    } else {
      ImGui::TextDisabled(paused ? "Paused" : "Waits for Go");
    }
    context.names.add("cues.state");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Simulated time until the next cue starts by itself");
  }

  // A menu that adds a cue after the one that has run last.
  void draw_add(GuiContext& context) {
    if (ImGui::Button("Add")) {
      name_.clear();
      ImGui::OpenPopup("add");
    }
    context.names.add("cues.add");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Add a cue after the one that has run last");
    ImGui::SameLine();
    if (!ImGui::BeginPopup("add")) return;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    bool add = ImGui::InputText("Name", &name_, ImGuiInputTextFlags_EnterReturnsTrue);
    context.names.add("cues.add_name");
    ImGui::Checkbox("with the present look as its preset", &with_look_);
    context.names.add("cues.add_look");
    add |= ImGui::Button("Add##now");
    context.names.add("cues.add_now");
    if (add && !name_.empty()) {
      std::vector<Arg> args = {Arg::of(std::string_view(name_))};
      if (with_look_) {
        context.send("/preset/store", args);
        args.push_back(args[0]);
      }
      context.send("/cue/add", std::move(args));
      ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
  }

  static void send_field(GuiContext& context, int number, std::string_view field, Arg value) {
    context.send("/cue/set", {Arg::of(static_cast<double>(number)), Arg::of(field), std::move(value)});
  }

  // The menu of a cue: its fields, and its place in the list.
  void draw_menu(GuiContext& context, int number, const std::string& fields) {
    if (!ImGui::BeginPopupContextItem("##menu")) return;
    if (ImGui::IsWindowAppearing()) {
      std::size_t i = 0;
      for (const std::string_view field : split(fields, '\t')) {
        if (i < edited_.size()) edited_[i++] = field;
      }
    }
    for (std::size_t i = 0; i < kFields.size(); i++) draw_field(context, number, i);
    const std::string& preset = edited_[1];
    ImGui::BeginDisabled(preset.empty());
    if (ImGui::Selectable("Store the present look in its preset"))
      context.send("/preset/store", {Arg::of(std::string_view(preset))});
    context.names.add("menu:cue_store");
    ImGui::EndDisabled();
    const auto move = [&](const char* label, const char* name, int to, bool possible) {
      ImGui::BeginDisabled(!possible);
      if (ImGui::Selectable(label))
        context.send("/cue/move", {Arg::of(static_cast<double>(number)), Arg::of(static_cast<double>(to))});
      context.names.add(name);
      ImGui::EndDisabled();
    };
    move("Move up", "menu:cue_up", number - 1, number > 1);
    move("Move down", "menu:cue_down", number + 1, number < count_);
    if (ImGui::Selectable("Delete")) context.send("/cue/remove", {Arg::of(static_cast<double>(number))});
    context.names.add("menu:cue_delete");
    ImGui::EndPopup();
  }

  void draw_field(GuiContext& context, int number, std::size_t i) {
    const CueField& field = kFields[i];
    std::string& text = edited_[i];
    if (field.choices[0] != nullptr) {
      if (ImGui::BeginCombo(field.name, text.c_str())) {
        for (const char* choice : field.choices) {
          if (choice == nullptr) continue;
          if (ImGui::Selectable(choice, text == choice)) {
            text = choice;
            send_field(context, number, field.name, Arg::of(choice));
          }
          context.names.add(fmt::format("cues.{}:{}", field.name, choice));
        }
        ImGui::EndCombo();
      }
    } else if (ImGui::InputText(field.name, &text, ImGuiInputTextFlags_EnterReturnsTrue)) {
      const std::optional<double> value = field.is_number ? parse_number(text) : std::nullopt;
      send_field(context, number, field.name, value ? Arg::of(*value) : Arg::of(std::string_view(text)));
    }
    context.names.add(fmt::format("cues.field:{}", field.name));
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%s", field.hint);
  }

  // The beat as a lamp that is bright at its start, the tempo, and its buttons.
  static void draw_clock(GuiContext& context) {
    const auto tempo = context.find("/clock/tempo");
    if (!tempo) return;
    const double beat = context.number("/clock/beat");
    const double beats_per_bar = std::max(context.number("/clock/beats_per_bar"), 1.0);
    const double beat_in_bar = std::floor(beat) - std::floor(beat / beats_per_bar) * beats_per_bar;  // from 0
    const bool playing = context.number("/clock/playing") != 0;
    if (ImGui::Button(playing ? "Stop###clock" : "Play###clock")) context.toggle("/clock/playing");
    context.names.add("clock.playing");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Stop the beat, or continue");
    ImGui::SameLine();
    draw_button(context, "Start", "/clock/start", "clock.start", "Start again at beat 0");
    draw_button(context, "Tap", "/clock/tap", "clock.tap", "Tap the tempo: click it on each beat (F7)");
    property_widget(context, *tempo, 90 * static_cast<float>(context.scale));
    context.names.add("clock.tempo");
    property_menu(context, *tempo);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = ImGui::GetFrameHeight();
    const auto fading = static_cast<float>(1 - (beat - std::floor(beat)));
    const ImU32 color = packed_color(beat_in_bar == 0 ? ThemeColor::accent : ThemeColor::text, playing ? fading : 0.1F);
    ImGui::GetWindowDrawList()->AddCircleFilled({at.x + size / 2, at.y + size / 2}, size / 4, color);
    ImGui::Dummy({size, size});
    ImGui::SameLine();
    ImGui::Text("%.0f.%.0f  %.1f", context.number("/clock/bar") + 1, beat_in_bar + 1,
                context.number("/clock/current_tempo"));
    context.names.add("clock.state");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Bar and beat, and the tempo now%s",
                        context.number("/clock/synced") != 0 ? ": another program leads the clock" : "");
  }

  // One line: number and name. The current cue is scrolled to when it has changed.
  void draw_cue(GuiContext& context, int number, const std::string& fields, int current) {
    const std::string name = fields.substr(0, fields.find('\t'));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool selected = number == current;
    ImGui::PushID(number);
    if (ImGui::Selectable("##cue", selected, 0, {0, ImGui::GetTextLineHeight()}))
      context.send("/cue/jump", {Arg::of(static_cast<double>(number))});
    context.names.add(fmt::format("cues.cue:{}", name));
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%d %s: click to start this cue, right click to edit it", number, name.c_str());
    if (selected && shown_ != current) ImGui::SetScrollHereY();
    draw_menu(context, number, fields);
    ImGui::PopID();
    // drawn here, because a name may contain "##", which ends a label of Dear ImGui
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const std::string digits = fmt::format("{}", number);
    const float column = ImGui::CalcTextSize("0000").x;
    list.AddText({at.x + column * 0.8F - ImGui::CalcTextSize(digits.c_str()).x, at.y},
                 packed_color(ThemeColor::secondary), digits.c_str());
    const std::string text = elided(name, ImGui::GetContentRegionAvail().x - column, text_width);
    list.AddText({at.x + column, at.y}, packed_color(selected ? ThemeColor::accent : ThemeColor::text), text.c_str());
  }

  std::array<std::string, kFields.size()> edited_;  // fields of the cue whose menu is open
  std::string name_;                                // of the cue to add
  bool with_look_ = true;
  int count_ = 0;
  int shown_ = 0;  // number of the current cue in the last frame
};

[[maybe_unused]] const bool kCuesPanel = register_panel_type<CuesPanel>({.name = "cues",
                                                                         .title = "Cues",
                                                                         .wide_slot = PanelSlot::bottom_middle,
                                                                         .compact_slot = PanelSlot::bottom,
                                                                         .order = 9});

}  // namespace
}  // namespace limber::panel
