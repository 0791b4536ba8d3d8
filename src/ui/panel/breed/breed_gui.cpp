// The cells and the panel of `limber breed`.
#include "ui/panel/breed/breed_gui.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

using Kind = BreedAction::Kind;

constexpr ImGuiWindowFlags kFrozen = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                     ImGuiWindowFlags_NoScrollWithMouse;
constexpr double kPanelWidth = 300;    // units
constexpr double kMaxPanelPart = 0.4;  // of the window's width
constexpr double kGap = 6;             // units
constexpr float kClickTolerance = 4;   // units that the mouse may move during a click
constexpr float kMinAmount = 0.01F;
constexpr float kMaxAmount = 0.5F;

struct BreedKey {
  KeyPress press;
  Kind kind;
};
constexpr std::array<BreedKey, 12> kKeys = {{
    {{GuiKey::m, {}}, Kind::mutate},
    {{GuiKey::c, {}}, Kind::cross},
    {{GuiKey::r, {}}, Kind::randomize},
    {{GuiKey::k, {}}, Kind::keep},
    {{GuiKey::z, {true, false, false}}, Kind::undo},
    {{GuiKey::y, {true, false, false}}, Kind::redo},
    {{GuiKey::z, {true, true, false}}, Kind::redo},
    {{GuiKey::r, {true, false, false}}, Kind::restart},
    {{GuiKey::home, {}}, Kind::restart},
    {{GuiKey::space, {}}, Kind::pause},
    {{GuiKey::f, {}}, Kind::follow},
    {{GuiKey::f11, {}}, Kind::full_screen},
}};

ImVec2 corner(const PanelRect& rect) { return {static_cast<float>(rect.x), static_cast<float>(rect.y)}; }
ImVec2 size_of(const PanelRect& rect) { return {static_cast<float>(rect.width), static_cast<float>(rect.height)}; }

// Text on a dark box, so that it can be read on any image.
void draw_label(ImDrawList& list, ImVec2 at, const std::string& text, ThemeColor color) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  list.AddRectFilled(at, {at.x + size.x + padding.x, at.y + size.y + padding.y}, packed_color(ThemeColor::panel, 0.9),
                     ImGui::GetStyle().FrameRounding);
  list.AddText({at.x + padding.x / 2, at.y + padding.y / 2}, packed_color(color), text.c_str());
}

}  // namespace

void BreedGui::act(Kind kind, std::size_t index) { actions_.push_back({kind, index, amount_, name_}); }

void BreedGui::handle_keys(const std::vector<KeyPress>& keys) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput) return;
  for (const KeyPress& press : keys) {
    // during keyboard navigation these keys act on the selected widget
    if (io.NavVisible && (press.key == GuiKey::space || press.key == GuiKey::home)) continue;
    const auto digit = static_cast<int>(press.key) - static_cast<int>(GuiKey::digit_1);
    if (press.mods == KeyMods{} && digit >= 0 && digit < static_cast<int>(BreedView::kCells))
      act(Kind::like, static_cast<std::size_t>(digit));
    const auto* const key = std::ranges::find(kKeys, press, &BreedKey::press);
    if (key != kKeys.end()) act(key->kind);
  }
}

// Begins the frame. Home doesn't begin the navigation by keyboard: it starts the variations again.
void BreedGui::new_frame(const std::vector<KeyPress>& keys) {
  ImGuiIO& io = ImGui::GetIO();
  const bool home = !io.NavVisible && std::ranges::find(keys, GuiKey::home, &KeyPress::key) != keys.end();
  if (home) io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
  ImGui::NewFrame();
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
}

void BreedGui::lay_out(const GuiFrame& frame) {
  const double scale = host_.scale();
  const double width = std::floor(std::min(kPanelWidth * scale, kMaxPanelPart * frame.width));
  gap_ = std::floor(kGap * scale);
  grid_ = {0, 0, frame.width - width, frame.height};
  panel_ = {grid_.width, 0, width, frame.height};
  const double across = (grid_.width - 4 * gap_) / 3;
  const double down = (grid_.height - 4 * gap_) / 3;
  cell_ = {gap_, gap_, std::max(1.0, std::floor(across)), std::max(1.0, std::floor(down))};
}

std::vector<BreedAction> BreedGui::frame(const GuiFrame& frame, double text_size, const BreedView& view) {
  const std::vector<KeyPress> keys = host_.begin_frame(frame, text_size);
  actions_.clear();
  names_.clear();
  moves_camera_ = false;
  lay_out(frame);
  handle_keys(keys);
  new_frame(keys);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);  // both windows cover the whole image
  draw_cells(view);
  draw_panel(view);
  ImGui::PopStyleVar();
  ImGui::Render();
  return std::exchange(actions_, {});
}

void BreedGui::draw_cells(const BreedView& view) {
  ImGui::SetNextWindowPos(corner(grid_));
  ImGui::SetNextWindowSize(size_of(grid_));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, packed_color(ThemeColor::back));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  if (ImGui::Begin("##cells", nullptr, kFrozen | ImGuiWindowFlags_NoNavInputs)) {
    for (std::size_t i = 0; i < BreedView::kCells; i++) draw_cell(view.cells[i], i);
  }
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

PanelRect BreedGui::rect_of(std::size_t index) const {
  const std::size_t column = index % 3;
  const std::size_t row = index / 3;
  return {cell_.x + static_cast<double>(column) * (cell_.width + gap_),
          cell_.y + static_cast<double>(row) * (cell_.height + gap_), cell_.width, cell_.height};
}

// A click likes the cell; a drag moves the cameras.
bool BreedGui::handle_cell(std::size_t index) {
  ImGui::SetCursorScreenPos(corner(rect_of(index)));
  (void)ImGui::InvisibleButton(fmt::format("##cell{}", index).c_str(), size_of(cell_));
  names_.add(fmt::format("cell:{}", index + 1));
  const bool hovered = ImGui::IsItemHovered();
  if (ImGui::IsItemActivated()) dragged_ = false;
  if (ImGui::IsItemActive()) {
    const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
    const float limit = kClickTolerance * static_cast<float>(host_.scale());
    dragged_ = dragged_ || std::abs(moved.x) > limit || std::abs(moved.y) > limit;
  }
  if (ImGui::IsItemDeactivated() && !dragged_ && hovered) act(Kind::like, index);
  moves_camera_ = moves_camera_ || ImGui::IsItemActive() || hovered;
  if (hovered) shown_ = index;
  return hovered;
}

void BreedGui::draw_cell(const BreedCell& cell, std::size_t index) {
  const bool hovered = handle_cell(index);
  const ImVec2 low = corner(rect_of(index));
  const ImVec2 high{low.x + static_cast<float>(cell_.width), low.y + static_cast<float>(cell_.height)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (cell.texture != 0) {
    list.AddImage(imgui::texture_id(cell.texture), low, high);
  } else {
    list.AddRectFilled(low, high, packed_color(ThemeColor::panel));
    constexpr const char* kStarting = "starting …";
    const ImVec2 size = ImGui::CalcTextSize(kStarting);
    if (cell.error.empty())
      list.AddText({(low.x + high.x - size.x) / 2, (low.y + high.y - size.y) / 2}, packed_color(ThemeColor::secondary),
                   kStarting);
  }
  const auto border = static_cast<float>((cell.liked ? 3 : 1) * host_.scale());
  const ThemeColor color = cell.liked ? ThemeColor::accent : hovered ? ThemeColor::secondary : ThemeColor::line;
  list.AddRect(low, high, packed_color(color), 0, 0, border);
  const ImVec2 inside{low.x + border + 2, low.y + border + 2};
  draw_label(
      list, inside,
      fmt::format("{}{}{}{}", index + 1, cell.kept ? "  parent" : "", cell.preset.empty() ? "" : "  ", cell.preset),
      cell.liked ? ThemeColor::accent : ThemeColor::text);
  draw_error(cell.error, inside, {high.x - border - 2, high.y - border - 2});
}

// At the lower edge of a cell, in a few lines.
void BreedGui::draw_error(const std::string& text, const ImVec2& low, const ImVec2& high) {
  if (text.empty()) return;
  constexpr std::size_t kMaxLines = 4;
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const std::string first = text.substr(0, text.find('\n'));  // an excerpt of the script may follow
  std::vector<std::string> lines = wrapped(first, high.x - low.x - padding.x, text_width);
  lines.resize(std::min(lines.size(), kMaxLines));
  float y = high.y;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    y -= ImGui::GetTextLineHeight() + padding.y;
    draw_label(*ImGui::GetWindowDrawList(), {low.x, y}, *line, ThemeColor::red);
  }
}

// The label shows the key if it fits.
bool BreedGui::button(const Button& button) {
  const float width = ImGui::GetContentRegionAvail().x;
  const float label_width = width - 2 * ImGui::GetStyle().FramePadding.x;
  std::string label = fmt::format("{}  {}", button.label, button.key);
  if (text_width(label) > label_width) label = elided(button.label, label_width, text_width);
  ImGui::BeginDisabled(!button.enabled);
  const bool pressed = ImGui::Button(fmt::format("{}###{}", label, button.name).c_str(), {width, 0});
  ImGui::EndDisabled();
  names_.add(button.name);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s (%s)", button.hint, button.key);
  return pressed;
}

void BreedGui::draw_panel(const BreedView& view) {
  ImGui::SetNextWindowPos(corner(panel_));
  ImGui::SetNextWindowSize(size_of(panel_));
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("##panel", nullptr, kFrozen)) {
    const auto liked = std::ranges::count_if(view.cells, &BreedCell::liked);
    ImGui::Text("Generation %llu", static_cast<unsigned long long>(view.generation));
    ImGui::SameLine();
    ImGui::TextDisabled(liked == 0 ? "click those you like" : "%d liked", static_cast<int>(liked));
    draw_operations(view);
    draw_keep(view);
    if (!view.notice.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, packed_color(view.failed ? ThemeColor::red : ThemeColor::secondary));
      ImGui::TextWrapped("%s", view.notice.c_str());
      ImGui::PopStyleColor();
      names_.add("breed.notice");
    }
    draw_parameters(view);
  }
  ImGui::End();
}

void BreedGui::draw_operations(const BreedView& view) {
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  float percent = 100 * amount_;
  if (ImGui::SliderFloat("##amount", &percent, 100 * kMinAmount, 100 * kMaxAmount, "change by %.0f %%",
                         ImGuiSliderFlags_AlwaysClamp))
    amount_ = percent / 100;
  names_.add("breed.amount");
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("How much Mutate changes: standard deviation, in percent of each parameter's range");
  const std::array<std::pair<Button, Kind>, 8> operations = {{
      {{"Mutate", "M", "breed.mutate", "Replace the others with variations of the liked ones"}, Kind::mutate},
      {{"Cross", "C", "breed.cross", "Replace the others with mixes of two liked ones"}, Kind::cross},
      {{"Undo", "Ctrl+Z", "breed.undo", "Return to the generation before", view.can_undo}, Kind::undo},
      {{"Redo", "Ctrl+Y", "breed.redo", "Go to the generation after", view.can_redo}, Kind::redo},
      {{"Random", "R", "breed.random", "Replace all that are not liked with random ones"}, Kind::randomize},
      {{view.paused ? "Play" : "Pause", "Space", "breed.pause", "Stop the time, or go on"}, Kind::pause},
      {{"Start again", "Home", "breed.restart", "Start all variations again at the same time"}, Kind::restart},
      {{view.following ? "Don't follow" : "Follow", "F", "breed.follow",
        "Move the cameras with the first body that has joints"},
       Kind::follow},
  }};
  if (!ImGui::BeginTable("##operations", 2, ImGuiTableFlags_SizingStretchSame | ImGuiTableFlags_NoSavedSettings))
    return;
  for (const auto& [operation, kind] : operations) {
    ImGui::TableNextColumn();
    if (button(operation)) act(kind);
  }
  ImGui::EndTable();
}

void BreedGui::draw_keep(const BreedView& view) {
  ImGui::Separator();
  const float space = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(space / 2);
  ImGui::InputText("##name", &name_);
  names_.add("breed.name");
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("Name of the presets; a number is added");
  ImGui::SameLine();
  const bool any_liked = std::ranges::any_of(view.cells, &BreedCell::liked);
  if (button({"Keep", "K", "breed.keep", "Store the liked ones as presets of the scene", any_liked && !name_.empty()}))
    act(Kind::keep);
}

void BreedGui::draw_parameters(const BreedView& view) {
  ImGui::Separator();
  ImGui::TextDisabled("Values of %d; a check mark holds one", static_cast<int>(shown_ + 1));
  if (ImGui::BeginChild("##parameters", {}, false, ImGuiWindowFlags_NavFlattened)) {
    for (std::size_t i = 0; i < view.parameters.size(); i++) draw_parameter(view, i);
  }
  ImGui::EndChild();
}

// A check box that holds it, its name, and the value of the shown cell as a bar.
void BreedGui::draw_parameter(const BreedView& view, std::size_t index) {
  const BreedParameter& parameter = view.parameters[index];
  const BreedCell& cell = view.cells[shown_];
  ImGui::PushID(static_cast<int>(index));
  bool held = parameter.held;
  if (ImGui::Checkbox("##held", &held)) act(Kind::hold, index);
  names_.add(fmt::format("hold:{}", parameter.name));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Hold: no operation changes it");
  ImGui::SameLine();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = ImGui::GetFrameHeight();
  ImGui::Dummy({width, height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool known = index < cell.positions.size() && index < cell.values.size();
  const float part = known ? static_cast<float>(std::clamp(cell.positions[index], 0.0, 1.0)) : 0;
  const float rounding = ImGui::GetStyle().FrameRounding;
  list.AddRectFilled(at, {at.x + width, at.y + height}, packed_color(ThemeColor::field), rounding);
  list.AddRectFilled(at, {at.x + part * width, at.y + height}, packed_color(ThemeColor::fill), rounding);
  const std::string value = known ? cell.values[index] : std::string();
  const float padding = ImGui::GetStyle().FramePadding.x;
  const float y = at.y + ImGui::GetStyle().FramePadding.y;
  const float value_width = text_width(value);
  const std::string name = elided(parameter.name, width - value_width - 3 * padding, text_width);
  list.AddText({at.x + padding, y}, packed_color(parameter.held ? ThemeColor::secondary : ThemeColor::text),
               name.c_str());
  list.AddText({at.x + width - padding - value_width, y}, packed_color(ThemeColor::text), value.c_str());
  ImGui::PopID();
}

}  // namespace limber::panel
