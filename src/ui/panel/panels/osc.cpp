// OSC monitor: incoming and outgoing messages, the counters and the targets. A frequent address is shown only a few
// times per second.
#include <deque>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/text.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

constexpr std::size_t kMonitorLines = 400;
constexpr int kMonitorHiddenFrames = 30;  // frames without drawing until messages are no longer logged
constexpr double kMonitorInterval = 0.5;  // s until an address is shown again
constexpr std::size_t kMonitorAddresses = 4096;

struct CounterText {
  const char* name;
  const char* hint;
};
constexpr CounterText kCounters[] = {
    {"In", "Messages received"},
    {"Out", "Datagrams sent"},
    {"Rejected", "Messages received that had an error: unknown addresses, wrong arguments, no permission"},
    {"Clamped", "Values received that were outside their range"},
    {"Dropped", "Messages received that were lost"}};

// The targets of OSC output, in a part that opens.
class OscTargets {
 public:
  void draw(GuiContext& context) {
    const std::uint64_t version = context.link.osc.version();
    if (version != version_) read(context.link.osc.targets());
    version_ = version;
    const bool open = ImGui::TreeNode("targets", "Targets: %d", static_cast<int>(targets_.size()));
    context.names.add("osc.targets");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Receivers of streams and events; click to add and remove them");
    if (!open) return;
    for (std::size_t i = 0; i < targets_.size(); i++) draw_target(context, targets_[i], static_cast<int>(i));
    draw_fields(context);
    ImGui::TreePop();
  }

 private:
  void read(std::string_view text) {
    targets_.clear();
    if (text.empty()) return;
    for (const std::string_view line : split(text, '\n')) targets_.emplace_back(line);
  }

  static void draw_target(GuiContext& context, const std::string& target, int number) {
    ImGui::PushID(number);
    const float button = ImGui::GetFrameHeight();
    const float width = ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x;
    const float right = ImGui::GetCursorPosX() + width + ImGui::GetStyle().ItemSpacing.x;
    ImGui::AlignTextToFramePadding();
    const std::string shown = elided(target, width, text_width);
    ImGui::TextUnformatted(shown.c_str());
    context.names.add(fmt::format("osc.target{}", number));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", target.c_str());
    ImGui::SameLine(right);
    const std::string_view address = std::string_view(target).substr(0, target.find(" ("));
    if (ImGui::Button("\u00d7", {button, 0})) context.send("/osc/target/remove", {Arg::of(address)});
    context.names.add(fmt::format("osc.target{}.remove", number));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Send nothing more to this target");
    ImGui::PopID();
  }

  void draw_fields(GuiContext& context) {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float padding = 2 * ImGui::GetStyle().FramePadding.x;
    const float buttons = text_width("Add") + text_width("Reset") + 2 * (padding + gap);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - buttons);
    bool added =
        ImGui::InputTextWithHint("##target", "192.168.1.5:9005,rate=30", &text_, ImGuiInputTextFlags_EnterReturnsTrue);
    context.names.add("osc.target");
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
      ImGui::SetTooltip("HOST:PORT and settings: rate=60, streams=pos+rot, bodies=arm*, bundle=1472, errors=on");
    ImGui::SameLine(0, gap);
    ImGui::BeginDisabled(text_.empty());
    added = ImGui::Button("Add") || added;
    context.names.add("osc.target.add");
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip("Add this target, or change the settings of one");
    ImGui::SameLine(0, gap);
    if (ImGui::Button("Reset")) context.send("/osc/target/reset");
    context.names.add("osc.target.reset");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The targets of the command line or the scene");
    if (added && !text_.empty()) context.send("/osc/target/add", {Arg::of(text_)});
  }

  std::uint64_t version_ = 0;
  std::vector<std::string> targets_;
  std::string text_;
};

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
    targets_.draw(context);
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
    const std::uint64_t counts[] = {c.received.load(), c.sent.load(), rejected, c.clamped.load(), lost};
    const ThemeColor tones[] = {ThemeColor::blue, ThemeColor::green,
                                rejected > 0 ? ThemeColor::accent : ThemeColor::secondary, ThemeColor::secondary,
                                lost > 0 ? ThemeColor::red : ThemeColor::secondary};
    float x = 0;
    for (std::size_t i = 0; i < std::size(kCounters); i++) {
      const std::string text =
          fmt::format("{} {}", kCounters[i].name, number_label(static_cast<double>(counts[i]), {.integer = true}));
      // in a second line if there is no room for it
      const bool fits = x + text_width(text) <= ImGui::GetContentRegionMax().x;
      if (i > 0 && fits) ImGui::SameLine();
      ImGui::PushStyleColor(ImGuiCol_Text, packed_color(tones[i]));
      ImGui::TextUnformatted(text.c_str());
      ImGui::PopStyleColor();
      x = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + ImGui::GetStyle().ItemSpacing.x;
      context.names.add(fmt::format("osc.counter{}", i));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", kCounters[i].hint);
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
    const std::string repeats =
        line.repeats == 0 ? "" : "\u00d7" + number_label(static_cast<double>(line.repeats) + 1, {.integer = true});
    const float space = repeats.empty() ? 0 : text_width(repeats) + ImGui::GetStyle().ItemSpacing.x;
    const std::string text = elided(line.text, ImGui::GetContentRegionAvail().x - space, text_width);
    if (ImGui::Selectable(fmt::format("{}###{}", text, i).c_str(), false, 0, {text_width(text), 0}))
      context.copy_with_notice(line.text);
    context.names.add(fmt::format("osc.line{}", i));
    if (text != line.text && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", line.text.c_str());
    if (repeats.empty()) return;
    ImGui::SameLine();
    ImGui::TextDisabled("%s", repeats.c_str());
  }

  OscTargets targets_;
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
                                                                       .title = "OSC",
                                                                       .wide_slot = PanelSlot::bottom_middle,
                                                                       .compact_slot = PanelSlot::bottom,
                                                                       .order = 2});

}  // namespace
}  // namespace limber::panel
