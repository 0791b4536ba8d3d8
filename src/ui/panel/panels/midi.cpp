// MIDI: the devices, the controls that set values, and the control that is being learned.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

class MidiPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    const std::size_t count = read(context).entries.size();
    return count > 0 ? fmt::format("{}", count) : "";
  }

  void draw(GuiContext& context) override {
    if (!context.link.midi.available())
      return ImGui::TextDisabled("MIDI is off: start without --midi off, and in real time");
    const engine::MidiReport& report = read(context);
    draw_state(context, report);
    if (!ImGui::BeginChild("##midi", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    for (const engine::MidiDeviceRow& device : report.devices) draw_device(context, device);
    if (report.entries.empty()) draw_hint(report);
    for (std::size_t i = 0; i < report.entries.size(); i++) draw_entry(context, report.entries[i], static_cast<int>(i));
    ImGui::EndChild();
  }

 private:
  // The report, copied when it has changed.
  const engine::MidiReport& read(const GuiContext& context) const {
    const std::uint64_t version = context.link.midi.version();
    if (version != version_) report_ = context.link.midi.report();
    version_ = version;
    return report_;
  }

  static void draw_hint(const engine::MidiReport& report) {
    const char* const text = report.on ? "No controls: right-click a value, choose MIDI learn, and move a control"
                                       : "Right-click a value, choose MIDI learn, and move a control";
    ImGui::TextDisabled("%s", text);
  }

  // The first line: the address that is being learned, an error, or the last event.
  static void draw_state(GuiContext& context, const engine::MidiReport& report) {
    ImGui::AlignTextToFramePadding();
    if (!report.learning.empty()) {
      if (ImGui::Button("Cancel")) context.send("/midi/learn");
      context.names.add("midi.cancel");
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("Stop learning");
      ImGui::SameLine();
      ImGui::AlignTextToFramePadding();
      draw_line(report.problem.empty() ? "Move the control for " + report.learning : report.problem,
                ThemeColor::accent);
    } else if (!report.file_error.empty() || !report.problem.empty()) {
      draw_line(report.file_error.empty() ? report.problem : report.file_error, ThemeColor::red);
    } else {
      draw_line(report.last_event.empty() ? "No control has moved yet" : report.last_event, ThemeColor::secondary);
    }
    context.names.add("midi.state");
  }

  // A text that is cut at the end of the line; the tooltip has all of it.
  static void draw_line(const std::string& text, ThemeColor color) {
    const std::string shown = elided(text, ImGui::GetContentRegionAvail().x, text_width);
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(color));
    ImGui::TextUnformatted(shown.c_str());
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
  }

  static void draw_device(GuiContext& context, const engine::MidiDeviceRow& device) {
    const char* const state = !device.present ? "unplugged" : device.output ? "in and out" : "in";
    const float width = ImGui::CalcTextSize(state).x;
    const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const std::string name = elided(device.name, ImGui::GetContentRegionAvail().x - width - gap, text_width);
    ImGui::TextUnformatted(name.c_str());
    context.names.add("midi.device:" + device.name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s: %s", device.name.c_str(), state);
    ImGui::SameLine(right);
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(device.present ? ThemeColor::green : ThemeColor::red));
    ImGui::TextUnformatted(state);
    ImGui::PopStyleColor();
  }

  // One line: address, control, and a button that removes the entry.
  static void draw_entry(GuiContext& context, const engine::MidiEntryRow& entry, int number) {
    ImGui::PushID(number);
    const float button = ImGui::GetFrameHeight();
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - button - gap;
    const float start = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    const std::string control = elided(entry.control, width * 0.5F, text_width);
    const float control_width = ImGui::CalcTextSize(control.c_str()).x;
    const std::string address = elided(entry.address, width - control_width - gap, text_width);
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(entry.problem ? ThemeColor::red : ThemeColor::text));
    ImGui::TextUnformatted(address.c_str());
    ImGui::PopStyleColor();
    context.names.add("midi.entry:" + entry.address);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s\n%s\n%s", entry.address.c_str(), entry.control.c_str(), entry.state.c_str());
    ImGui::SameLine(start + width - control_width);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", control.c_str());
    ImGui::SameLine(start + width + gap);
    if (ImGui::Button("\u00d7", {button, 0})) forget(context, entry.address);
    context.names.add("midi.forget:" + entry.address);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Remove this control");
    ImGui::PopID();
  }

  // The text of an address may end with a component: "/physics/sim/gravity [3]".
  static void forget(GuiContext& context, const std::string& text) {
    const std::size_t bracket = text.rfind(" [");
    std::vector<Arg> args = {Arg::of(std::string_view(text).substr(0, bracket))};
    if (bracket != std::string::npos) args.push_back(Arg::of(static_cast<double>(text[bracket + 2] - '0')));
    context.send("/midi/forget", std::move(args));
  }

  mutable std::uint64_t version_ = 0;
  mutable engine::MidiReport report_;
};

[[maybe_unused]] const bool kMidiPanel = register_panel_type<MidiPanel>({.name = "midi",
                                                                         .title = "MIDI",
                                                                         .wide_slot = PanelSlot::bottom_middle,
                                                                         .compact_slot = PanelSlot::bottom,
                                                                         .order = 10});

}  // namespace
}  // namespace limber::panel
