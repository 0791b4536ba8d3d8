// Lua console: evaluates expressions in the scene's environment like `limber console`, with history, completion and
// output.
#include <algorithm>
#include <deque>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/log/log.h"
#include "ui/panel/evaluator.h"
#include "ui/panel/gui.h"
#include "ui/panel/panel.h"
#include "ui/panel/theme.h"

namespace limber::panel {

namespace {

constexpr std::size_t kConsoleLines = 500;

class ConsolePanel : public Panel {
 public:
  void update(GuiContext& context) override {
    if (!initialized_) history_ = context.options->history;
    initialized_ = true;
    for (const LogLine& line : log_since(last_line_)) {
      last_line_ = line.number;
      if (line.level == LogLevel::print) show(ThemeColor::text, line.text);
    }
    for (const Evaluator::Response& response : evaluator_.consume_responses()) handle_response(response);
  }

  void draw(GuiContext& context) override {
    const float field = ImGui::GetFrameHeightWithSpacing();
    ImGui::PushFont(context.fonts.code);
    if (ImGui::BeginChild("##output", {0, -field})) draw_output();
    ImGui::EndChild();
    context.names.add("console.output");
    ImGui::SetNextItemWidth(-1);
    ImGui::PushID("console");
    constexpr ImGuiInputTextFlags kFlags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory |
                                           ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackAlways;
    context_ = &context;
    const bool entered =
        ImGui::InputTextWithHint("##line", incomplete_.empty() ? "lua>" : "   …", &text_, kFlags, on_edit, this);
    ImGui::PopID();
    context.names.add("console.line");
    ImGui::PopFont();
    if (!entered) return;
    ImGui::SetKeyboardFocusHere(-1);
    enter(context);
  }

 private:
  struct Line {
    ThemeColor color;
    std::string text;
  };

  void show(ThemeColor color, const std::string& text) {
    std::size_t begin = 0;
    while (begin <= text.size()) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      lines_.push_back({color, text.substr(begin, end - begin)});
      begin = end + 1;
    }
    while (lines_.size() > kConsoleLines) lines_.pop_front();
    scroll_to_end_ = true;
  }

  void draw_output() {
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines_.size()));
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) {
        const Line& line = lines_[static_cast<std::size_t>(i)];
        ImGui::PushStyleColor(ImGuiCol_Text, packed_color(line.color));
        ImGui::TextUnformatted(line.text.c_str(), line.text.c_str() + line.text.size());
        ImGui::PopStyleColor();
      }
    }
    if (scroll_to_end_) ImGui::SetScrollHereY(1);
    scroll_to_end_ = false;
  }

  void enter(GuiContext& context) {
    const std::string line = std::exchange(text_, {});
    history_position_ = history_.size();
    if (line.find_first_not_of(" \t") == std::string::npos && incomplete_.empty()) return;
    show(ThemeColor::secondary, (incomplete_.empty() ? "> " : "… ") + line);
    if (history_.empty() || history_.back() != line) history_.push_back(line);
    history_position_ = history_.size();
    context.options->store_line(line);
    incomplete_ += (incomplete_.empty() ? "" : "\n") + line;
    run_request_ = evaluator_.request(context.link, incomplete_);
    if (run_request_ == 0) show(ThemeColor::red, "The simulation's queue is full; try again");
  }

  void handle_response(const Evaluator::Response& response) {
    const Evaluation& result = response.result;
    if (result.kind == Evaluation::Kind::names) return complete(response);
    // an incomplete text waits for its next line
    if (result.kind == Evaluation::Kind::incomplete) return;
    incomplete_.clear();
    if (result.kind == Evaluation::Kind::value) show(ThemeColor::text, result.text);
    if (result.kind == Evaluation::Kind::error) show(ThemeColor::red, result.text);
  }

  // Inserts the common prefix of the names; lists them if there are several.
  void complete(const Evaluator::Response& response) {
    if (response.id != completion_request_ || response.result.text.empty()) return;
    std::vector<std::string> names;
    std::size_t begin = 0;
    while (begin < response.result.text.size()) {
      const std::size_t end = std::min(response.result.text.find('\n', begin), response.result.text.size());
      names.push_back(response.result.text.substr(begin, end - begin));
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
      show(ThemeColor::blue, list + (names.size() > 40 ? "  …" : ""));
    }
    completion_ = {completed_text_, response.result.word, shared};
  }

  static int on_edit(ImGuiInputTextCallbackData* data) {
    auto& self = *static_cast<ConsolePanel*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) self.browse_history(*data);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
      self.completed_text_.assign(data->Buf, static_cast<std::size_t>(data->CursorPos));
      self.completion_request_ = self.evaluator_.request(self.context_->link, self.completed_text_,
                                                         engine::EvaluationRequest::Action::complete);
    }
    if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways) self.insert_completion(*data);
    return 0;
  }

  void browse_history(ImGuiInputTextCallbackData& data) {
    history_position_ = std::min(history_position_, history_.size());
    if (data.EventKey == ImGuiKey_UpArrow && history_position_ > 0) history_position_--;
    if (data.EventKey == ImGuiKey_DownArrow && history_position_ < history_.size()) history_position_++;
    data.DeleteChars(0, data.BufTextLen);
    if (history_position_ < history_.size()) data.InsertChars(0, history_[history_position_].c_str());
  }

  // Inserts the completion if the text before the cursor has not changed meanwhile.
  void insert_completion(ImGuiInputTextCallbackData& data) {
    if (completion_.replacement.empty()) return;
    const Completion completion = std::exchange(completion_, {});
    const auto cursor = static_cast<std::size_t>(data.CursorPos);
    if (std::string_view(data.Buf, cursor) != completion.prefix || completion.replaced_bytes > cursor) return;
    data.DeleteChars(static_cast<int>(cursor - completion.replaced_bytes), static_cast<int>(completion.replaced_bytes));
    data.InsertChars(static_cast<int>(cursor - completion.replaced_bytes), completion.replacement.c_str());
  }

  struct Completion {
    std::string prefix;              // text before the cursor
    std::size_t replaced_bytes = 0;  // number of its bytes to replace
    std::string replacement;
  };

  Evaluator evaluator_;
  std::deque<Line> lines_;
  std::string text_;
  std::string incomplete_;  // lines of an incomplete text
  std::vector<std::string> history_;
  std::size_t history_position_ = 0;
  std::string completed_text_;
  std::uint64_t completion_request_ = 0;
  std::uint64_t run_request_ = 0;
  Completion completion_;
  GuiContext* context_ = nullptr;
  std::uint64_t last_line_ = log_newest();
  bool initialized_ = false;
  bool scroll_to_end_ = false;
};

[[maybe_unused]] const bool kConsolePanel = register_panel_type<ConsolePanel>({.name = "console",
                                                                               .title = "Lua console",
                                                                               .wide_slot = PanelSlot::bottom,
                                                                               .compact_slot = PanelSlot::bottom,
                                                                               .order = 0});

}  // namespace
}  // namespace limber::panel
