// Lua console: any expression in the scene's environment, as `limber console` has it: history, completion, what it
// prints.
#include <algorithm>
#include <deque>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/log.h"
#include "gui/evaluator.h"
#include "gui/gui.h"
#include "gui/panel.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr std::size_t kConsoleLines = 500;  // lines

class ConsolePanel : public Panel {
 public:
  void hear(Desk& desk) override {
    if (!begun_) history_ = desk.options->history;
    begun_ = true;
    for (const LogLine& line : log_since(seen_)) {
      seen_ = line.number;
      if (line.level == LogLevel::print) show(Tone::text, line.text);
    }
    for (const Evaluator::Answer& answer : evaluator_.answers()) take(answer);
  }

  void draw(Desk& desk) override {
    const float field = ImGui::GetFrameHeightWithSpacing();
    ImGui::PushFont(desk.fonts.code);
    if (ImGui::BeginChild("##said", {0, -field})) said();
    ImGui::EndChild();
    desk.names.note("console.said");
    ImGui::SetNextItemWidth(-1);
    ImGui::PushID("console");
    constexpr ImGuiInputTextFlags kFlags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory |
                                           ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackAlways;
    asking_ = &desk;
    const bool entered =
        ImGui::InputTextWithHint("##line", more_.empty() ? "lua>" : "   …", &text_, kFlags, on_edit, this);
    ImGui::PopID();
    desk.names.note("console.line");
    ImGui::PopFont();
    if (!entered) return;
    ImGui::SetKeyboardFocusHere(-1);
    enter(desk);
  }

 private:
  struct Line {
    Tone tone;
    std::string text;
  };

  void show(Tone tone, const std::string& text) {
    std::size_t begin = 0;
    while (begin <= text.size()) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      lines_.push_back({tone, text.substr(begin, end - begin)});
      begin = end + 1;
    }
    while (lines_.size() > kConsoleLines) lines_.pop_front();
    to_end_ = true;
  }

  void said() {
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines_.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) {
        const Line& line = lines_[static_cast<std::size_t>(i)];
        ImGui::PushStyleColor(ImGuiCol_Text, packed(line.tone));
        ImGui::TextUnformatted(line.text.c_str(), line.text.c_str() + line.text.size());
        ImGui::PopStyleColor();
      }
    }
    if (to_end_) ImGui::SetScrollHereY(1);
    to_end_ = false;
  }

  void enter(Desk& desk) {
    const std::string line = std::exchange(text_, {});
    at_ = history_.size();
    if (line.find_first_not_of(" \t") == std::string::npos && more_.empty()) return;
    show(Tone::dim, (more_.empty() ? "> " : "… ") + line);
    if (history_.empty() || history_.back() != line) history_.push_back(line);
    at_ = history_.size();
    desk.options->remember(line);
    more_ += (more_.empty() ? "" : "\n") + line;
    run_ = evaluator_.ask(desk.link, more_);
    if (run_ == 0) show(Tone::red, "the simulation takes no more just now");
  }

  void take(const Evaluator::Answer& answer) {
    const Evaluation& said = answer.said;
    if (said.kind == Evaluation::Kind::names) return complete(answer);
    // what an unfinished text has so far waits for its next line
    if (said.kind == Evaluation::Kind::incomplete) return;
    more_.clear();
    if (said.kind == Evaluation::Kind::value) show(Tone::text, said.text);
    if (said.kind == Evaluation::Kind::error) show(Tone::red, said.text);
  }

  // the beginning that all names share goes into the field; more than one are listed
  void complete(const Evaluator::Answer& answer) {
    if (answer.id != completes_ || answer.said.text.empty()) return;
    std::vector<std::string> names;
    std::size_t begin = 0;
    while (begin < answer.said.text.size()) {
      const std::size_t end = std::min(answer.said.text.find('\n', begin), answer.said.text.size());
      names.push_back(answer.said.text.substr(begin, end - begin));
      begin = end + 1;
    }
    std::string shared = names.front();
    for (const std::string& name : names) {
      std::size_t same = 0;
      while (same < shared.size() && same < name.size() && shared[same] == name[same]) same++;
      shared.resize(same);
    }
    if (names.size() > 1) {
      std::string list;
      for (std::size_t i = 0; i < names.size() && i < 40; i++) list += (i > 0 ? "  " : "") + names[i];
      show(Tone::blue, list + (names.size() > 40 ? "  …" : ""));
    }
    completion_ = {completed_, answer.said.word, shared};
  }

  static int on_edit(ImGuiInputTextCallbackData* data) {
    auto& self = *static_cast<ConsolePanel*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) self.walk(*data);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
      self.completed_.assign(data->Buf, static_cast<std::size_t>(data->CursorPos));
      self.completes_ = self.evaluator_.ask(self.asking_->link, self.completed_, Evaluate::Wish::complete);
    }
    if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways) self.fill_in(*data);
    return 0;
  }

  void walk(ImGuiInputTextCallbackData& data) {
    at_ = std::min(at_, history_.size());
    if (data.EventKey == ImGuiKey_UpArrow && at_ > 0) at_--;
    if (data.EventKey == ImGuiKey_DownArrow && at_ < history_.size()) at_++;
    data.DeleteChars(0, data.BufTextLen);
    if (at_ < history_.size()) data.InsertChars(0, history_[at_].c_str());
  }

  // what was completed is still what stands before the cursor
  void fill_in(ImGuiInputTextCallbackData& data) {
    if (completion_.with.empty()) return;
    const Completion with = std::exchange(completion_, {});
    const auto cursor = static_cast<std::size_t>(data.CursorPos);
    if (std::string_view(data.Buf, cursor) != with.of || with.word > cursor) return;
    data.DeleteChars(static_cast<int>(cursor - with.word), static_cast<int>(with.word));
    data.InsertChars(static_cast<int>(cursor - with.word), with.with.c_str());
  }

  struct Completion {
    std::string of;        // the text before the cursor
    std::size_t word = 0;  // bytes of it that are replaced
    std::string with;
  };

  Evaluator evaluator_;
  std::deque<Line> lines_;
  std::string text_;
  std::string more_;  // of a text that is not whole yet
  std::vector<std::string> history_;
  std::size_t at_ = 0;
  std::string completed_;
  std::uint64_t completes_ = 0;
  std::uint64_t run_ = 0;
  Completion completion_;
  Desk* asking_ = nullptr;
  std::uint64_t seen_ = log_newest();
  bool begun_ = false;
  bool to_end_ = false;
};

[[maybe_unused]] const bool kConsolePanel = panel<ConsolePanel>(
    {.name = "console", .title = "Lua console", .wide = Slot::below, .compact = Slot::below, .order = 0});

}  // namespace
}  // namespace limber
