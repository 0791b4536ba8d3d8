// OSC monitor: incoming and outgoing messages and the counters. A frequent address is shown only a few times per
// second.
#include <deque>
#include <memory>
#include <unordered_map>

#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel/panel.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"

namespace limber::panel {

namespace {

constexpr std::size_t kMonitorLines = 400;
constexpr int kMonitorHiddenFrames = 30;  // frames without drawing until messages are no longer logged
constexpr double kMonitorInterval = 0.5;  // s until an address is shown again
constexpr std::size_t kMonitorAddresses = 4096;

class OscPanel : public Panel {
 public:
  void draw(GuiContext& context) override {
    // messages are logged only while the monitor is visible
    hidden_frames_ = 0;
    if (watch_ == nullptr) {
      last_line_ = context.link.message_log.newest();
      watch_ = std::make_unique<engine::MessageLog::Watch>(context.link.message_log);
    }
    draw_counters(context);
    search_field(context.names, "osc.filter", "Filter addresses", filter_, -1);
    for (const engine::LoggedMessage& line : context.link.message_log.since(last_line_)) add_line(line);
    if (!ImGui::BeginChild("##lines", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    ImGui::PushFont(context.fonts.code);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines_.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) draw_line(context, i);
    }
    const bool low = ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1;
    if (low) ImGui::SetScrollHereY(1);
    ImGui::PopFont();
    if (lines_.empty()) ImGui::TextDisabled("No messages yet");
    ImGui::EndChild();
  }

  void update(GuiContext&) override {
    if (hidden_frames_++ > kMonitorHiddenFrames) watch_.reset();
  }

 private:
  struct Line {
    bool in = false;
    std::string text;
    std::uint64_t repeats = 0;  // number of further messages with this address
  };
  struct ShownAddress {
    double shown = 0;          // s
    std::uint64_t number = 0;  // of its last line
  };

  static void draw_counters(GuiContext& context) {
    const engine::Counters& c = context.link.counters;
    const std::uint64_t lost = c.dropped.load() + c.dropped_kernel.load();
    const std::uint64_t rejected = c.malformed.load() + c.denied.load() + c.unknown.load() + c.refused.load();
    const std::string texts[] = {fmt::format("In {}", c.received.load()), fmt::format("Out {}", c.sent.load()),
                                 fmt::format("Rejected {}", rejected), fmt::format("Clamped {}", c.clamped.load()),
                                 fmt::format("Dropped {}", lost)};
    const ThemeColor tones[] = {ThemeColor::blue, ThemeColor::green,
                                rejected > 0 ? ThemeColor::accent : ThemeColor::secondary, ThemeColor::secondary,
                                lost > 0 ? ThemeColor::red : ThemeColor::secondary};
    for (std::size_t i = 0; i < 5; i++) {
      if (i > 0) ImGui::SameLine();
      ImGui::PushStyleColor(ImGuiCol_Text, packed_color(tones[i]));
      ImGui::TextUnformatted(texts[i].c_str());
      ImGui::PopStyleColor();
      context.names.add(fmt::format("osc.counter{}", i));
    }
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Dropped by Limber: %llu, by the kernel: %llu",
                        static_cast<unsigned long long>(c.dropped.load()),
                        static_cast<unsigned long long>(c.dropped_kernel.load()));
  }

  void add_line(const engine::LoggedMessage& line) {
    last_line_ = line.number;
    if (!filter_.empty() && line.message.address.find(filter_) == std::string::npos) return;
    if (shown_addresses_.size() > kMonitorAddresses) shown_addresses_.clear();
    ShownAddress& entry = shown_addresses_[(line.incoming ? "<" : ">") + line.message.address];
    const bool is_new = entry.number == 0 || entry.number <= removed_count_;
    if (!is_new && line.time - entry.shown < kMonitorInterval) {
      lines_[static_cast<std::size_t>(entry.number - removed_count_ - 1)].repeats++;
      return;
    }
    entry.shown = line.time;
    entry.number = ++line_count_;
    lines_.push_back({line.incoming, engine::message_text(line.message), 0});
    while (lines_.size() > kMonitorLines) {
      lines_.pop_front();
      removed_count_++;
    }
  }

  void draw_line(GuiContext& context, int i) const {
    const Line& line = lines_[static_cast<std::size_t>(i)];
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(line.in ? ThemeColor::blue : ThemeColor::green));
    ImGui::TextUnformatted(line.in ? "<" : ">");
    ImGui::PopStyleColor();
    ImGui::SameLine();
    if (ImGui::Selectable(fmt::format("{}##{}", line.text, i).c_str())) context.copy_with_notice(line.text);
    context.names.add(fmt::format("osc.line{}", i));
    if (line.repeats == 0) return;
    ImGui::SameLine();
    ImGui::TextDisabled("\u00d7%llu", static_cast<unsigned long long>(line.repeats) + 1);
  }

  std::unique_ptr<engine::MessageLog::Watch> watch_;
  int hidden_frames_ = 0;  // number of frames since the monitor was last drawn
  std::uint64_t last_line_ = 0;
  std::string filter_;
  std::deque<Line> lines_;
  std::unordered_map<std::string, ShownAddress> shown_addresses_;
  std::uint64_t line_count_ = 0;     // total number of lines
  std::uint64_t removed_count_ = 0;  // number of removed lines
};

[[maybe_unused]] const bool kOscPanel = register_panel_type<OscPanel>({.name = "osc",
                                                                       .title = "OSC monitor",
                                                                       .wide_slot = PanelSlot::bottom_middle,
                                                                       .compact_slot = PanelSlot::bottom,
                                                                       .order = 2});

}  // namespace
}  // namespace limber::panel
