// OSC monitor: what comes in and goes out, with the counters. An address that comes often is shown a few times a
// second.
#include <deque>
#include <memory>
#include <unordered_map>

#include <fmt/format.h>
#include <imgui.h>

#include "gui/panel.h"
#include "gui/search_field.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr std::size_t kMonitorLines = 400;
constexpr int kMonitorUnseen = 30;     // frames until traffic is noted no longer
constexpr double kMonitorAgain = 0.5;  // s until an address is shown again
constexpr std::size_t kMonitorAddresses = 4096;

class OscPanel : public Panel {
 public:
  void draw(Desk& desk) override {
    // traffic is noted only while somebody looks
    unseen_ = 0;
    if (watch_ == nullptr) {
      seen_ = desk.link.traffic.newest();
      watch_ = std::make_unique<Traffic::Watch>(desk.link.traffic);
    }
    counters(desk);
    search_field(desk, "osc.filter", "filter addresses", filter_, -1);
    for (const TrafficLine& line : desk.link.traffic.since(seen_)) take(line);
    if (!ImGui::BeginChild("##lines", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    ImGui::PushFont(desk.fonts.code);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines_.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) show(desk, i);
    }
    const bool low = ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1;
    if (low) ImGui::SetScrollHereY(1);
    ImGui::PopFont();
    if (lines_.empty()) ImGui::TextDisabled("nothing yet");
    ImGui::EndChild();
  }

  void hear(Desk&) override {
    if (unseen_++ > kMonitorUnseen) watch_.reset();
  }

 private:
  struct Line {
    bool in = false;
    std::string text;
    std::uint64_t more = 0;  // of the same address since
  };
  struct Known {
    double shown = 0;          // s
    std::uint64_t number = 0;  // of its last line
  };

  static void counters(Desk& desk) {
    const Counters& c = desk.link.counters;
    const std::uint64_t lost = c.dropped.load() + c.dropped_kernel.load();
    const std::uint64_t bad = c.malformed.load() + c.denied.load() + c.unknown.load() + c.refused.load();
    const std::string texts[] = {fmt::format("in {}", c.received.load()), fmt::format("out {}", c.sent.load()),
                                 fmt::format("refused {}", bad), fmt::format("clamped {}", c.clamped.load()),
                                 fmt::format("lost {}", lost)};
    const Tone tones[] = {Tone::blue, Tone::green, bad > 0 ? Tone::accent : Tone::dim, Tone::dim,
                          lost > 0 ? Tone::red : Tone::dim};
    for (std::size_t i = 0; i < 5; i++) {
      if (i > 0) ImGui::SameLine();
      ImGui::PushStyleColor(ImGuiCol_Text, packed(tones[i]));
      ImGui::TextUnformatted(texts[i].c_str());
      ImGui::PopStyleColor();
      desk.names.note(fmt::format("osc.counter{}", i));
    }
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("lost here: %llu, by the kernel: %llu", static_cast<unsigned long long>(c.dropped.load()),
                        static_cast<unsigned long long>(c.dropped_kernel.load()));
  }

  void take(const TrafficLine& line) {
    seen_ = line.number;
    if (!filter_.empty() && line.message.address.find(filter_) == std::string::npos) return;
    if (known_.size() > kMonitorAddresses) known_.clear();
    Known& known = known_[(line.in ? "<" : ">") + line.message.address];
    const bool fresh = known.number == 0 || known.number <= gone_;
    if (!fresh && line.time - known.shown < kMonitorAgain) {
      lines_[static_cast<std::size_t>(known.number - gone_ - 1)].more++;
      return;
    }
    known.shown = line.time;
    known.number = ++made_;
    lines_.push_back({line.in, message_text(line.message), 0});
    while (lines_.size() > kMonitorLines) {
      lines_.pop_front();
      gone_++;
    }
  }

  void show(Desk& desk, int i) const {
    const Line& line = lines_[static_cast<std::size_t>(i)];
    ImGui::PushStyleColor(ImGuiCol_Text, packed(line.in ? Tone::blue : Tone::green));
    ImGui::TextUnformatted(line.in ? "<" : ">");
    ImGui::PopStyleColor();
    ImGui::SameLine();
    if (ImGui::Selectable(fmt::format("{}##{}", line.text, i).c_str())) desk.copied(line.text);
    desk.names.note(fmt::format("osc.line{}", i));
    if (line.more == 0) return;
    ImGui::SameLine();
    ImGui::TextDisabled("\u00d7%llu", static_cast<unsigned long long>(line.more) + 1);
  }

  std::unique_ptr<Traffic::Watch> watch_;
  int unseen_ = 0;  // frames
  std::uint64_t seen_ = 0;
  std::string filter_;
  std::deque<Line> lines_;
  std::unordered_map<std::string, Known> known_;
  std::uint64_t made_ = 0;  // lines so far,
  std::uint64_t gone_ = 0;  // of these forgotten
};

[[maybe_unused]] const bool kOscPanel = panel<OscPanel>(
    {.name = "osc", .title = "OSC monitor", .wide = Slot::below_middle, .compact = Slot::below, .order = 2});

}  // namespace
}  // namespace limber
