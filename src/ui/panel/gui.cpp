// The frame loop of the panel: input, snapshots, layout, drawing, help.
#include "ui/panel/gui.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "base/log/log.h"
#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/confirmation.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar |
                                    ImGuiWindowFlags_NoScrollWithMouse;  // scrolling is done by child windows

// windows above the panels
constexpr ImGuiWindowFlags kOverlay = kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus;

constexpr float kHelpMargins = 12;  // pixels, of both sides together

// True for actions that the window performs.
bool is_of_window(HotkeyAction action) {
  return action == HotkeyAction::toggle_output_window || action == HotkeyAction::toggle_full_screen ||
         action == HotkeyAction::default_view;
}

// Pixels beside the titles of a row of tabs, and between the tabs.
struct TabSpacing {
  float padding = 0, gap = 0;
  bool fits = true;
};

// Returns the usual spacing, or a part of it if the titles don't fit otherwise.
TabSpacing tab_spacing(const std::vector<std::string>& titles) {
  const TabSpacing usual{ImGui::GetStyle().FramePadding.x, ImGui::GetStyle().ItemSpacing.x};
  const auto count = static_cast<float>(titles.size());
  float text = 0;
  for (const std::string& title : titles) text += text_width(title);
  const float space = ImGui::GetContentRegionAvail().x - text;
  const float wanted = 2 * count * usual.padding + (count - 1) * usual.gap;
  const float part = std::clamp(space / wanted, 0.3F, 1.0F);
  return {std::floor(part * usual.padding), std::floor(part * usual.gap), part * wanted <= space};
}

bool frames(HotkeyAction action) {
  return action == HotkeyAction::frame_selection || action == HotkeyAction::frame_all;
}

// Returns the property that an action toggles, or null.
const char* toggled_path(HotkeyAction action) {
  if (action == HotkeyAction::toggle_overlay) return "/visuals/look/overlay";
  if (action == HotkeyAction::toggle_lights) return "/lighting/armed";
  return action == HotkeyAction::toggle_blackout ? "/lighting/blackout" : nullptr;
}

// Returns the message without arguments that an action sends, or null.
const char* sent_address(HotkeyAction action) {
  if (action == HotkeyAction::reset) return "/transport/reset";
  if (action == HotkeyAction::next_cue) return "/cue/go";
  if (action == HotkeyAction::tap_tempo) return "/clock/tap";
  if (action == HotkeyAction::previous_cue) return "/cue/back";
  return action == HotkeyAction::pause_cues ? "/cue/pause" : nullptr;
}

// Performs the hotkey actions that only need the context.
void perform_in_context(HotkeyAction action, GuiContext& context) {
  switch (action) {
    case HotkeyAction::play_pause:
      if (context.snapshot != nullptr) context.send(context.snapshot->paused ? "/transport/play" : "/transport/pause");
      break;
    case HotkeyAction::step_forward:
      context.step_time(1);
      break;
    case HotkeyAction::step_back:
      context.step_time(-1);
      break;
    case HotkeyAction::rewind:
      context.rewind(kRewindSeconds);
      break;
    case HotkeyAction::toggle_recording:
      context.toggle_recording();
      break;
    case HotkeyAction::toggle_take_playback:
      context.toggle_take_playback();
      break;
    case HotkeyAction::panic:
      context.panic();
      break;
    case HotkeyAction::undo:
      context.undo();
      break;
    case HotkeyAction::redo:
      context.redo();
      break;
    default:
      if (const char* const path = toggled_path(action)) context.toggle(path);
      if (const char* const address = sent_address(action)) context.send(address);
      break;
  }
}

}  // namespace

Gui::Gui(engine::EngineLink& link, GuiOptions options) : options_(std::move(options)), host_(options_), context_(link) {
  context_.settings = options_.settings;
  hotkeys_ = Hotkeys(context_.settings.keys);
  for (const std::string& error : hotkeys_.errors()) log_warning("panel settings: {}", error);
  context_.copy = options_.copy;
  context_.options = &options_;
  for (const PanelType& type : panel_types()) panels_.push_back({type, type.make()});
}

Gui::~Gui() = default;

// Names may contain characters that both fonts lack. Only these are loaded from the fallback font, which has thousands
// of glyphs.
void Gui::collect_name_characters() {
  if (context_.value_snapshot == nullptr || context_.value_snapshot->tree == characters_tree_) return;
  characters_tree_ = context_.value_snapshot->tree;
  const bool had_fallback = !extra_characters_.empty();
  for (std::uint32_t node = 0; node < characters_tree_->nodes().size(); node++)
    characters_changed_ = collect_characters(characters_tree_->name(node), extra_characters_) || characters_changed_;
  if (!characters_changed_ || host_.has_fallback_font()) return;
  characters_changed_ = false;
  if (!had_fallback)
    log_warning(
        "some names contain characters that no installed font has. Install one, for example with apt-get install "
        "fonts-noto-cjk");
}

void Gui::frame(const GuiFrame& frame) {
  const std::vector<KeyPress> keys = host_.begin_frame(frame, context_.settings.text_size, extra_characters_,
                                                       std::exchange(characters_changed_, false));
  context_.fonts = host_.fonts();
  context_.scale = host_.scale();
  context_.begin_frame(frame.clock);
  collect_name_characters();
  context_.names.clear();
  layout_ = lay_out(frame.width, frame.height, context_.scale);
  handle_keys(keys);
  ImGui::NewFrame();
  for (const DockedPanel& docked : panels_) docked.panel->update(context_);
  if (!context_.settings.hidden && context_.snapshot != nullptr && context_.value_snapshot != nullptr) {
    for (std::size_t i = 0; i < layout_.slots.size(); i++) draw_slot(static_cast<PanelSlot>(i));
  }
  if (context_.spring_marker) draw_spring(*context_.spring_marker);
  if (!context_.settings.hidden && context_.panicked()) draw_panic();
  if (context_.show_help) draw_help();
  draw_confirmation(context_);
  if (context_.notice.visible(context_.clock)) draw_notice();
  if (!ImGui::IsAnyItemActive()) context_.end_drag();
  ImGui::Render();
}

bool Gui::wants_mouse() const {
  host_.make_current();
  return ImGui::GetIO().WantCaptureMouse;
}

std::vector<HotkeyAction> Gui::consume_actions() { return std::exchange(actions_, {}); }

void Gui::handle_keys(const std::vector<KeyPress>& keys) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!context_.show_help) rebinding_.clear();
  for (const KeyPress& press : keys) {
    if (!rebinding_.empty()) {
      bind_key(press);
      continue;
    }
    if (handle_confirmation_key(context_, press)) continue;
    // during keyboard navigation these keys act on the selected widget
    if (io.NavVisible && (press.key == GuiKey::space || press.key == GuiKey::home)) continue;
    const Hotkey* const hotkey = hotkeys_.match(press, io.WantTextInput);
    if (hotkey != nullptr) perform(hotkey->action, press);
  }
}

// Binds the pressed key to the hotkey that was clicked in the help. Escape cancels, Delete restores the default.
void Gui::bind_key(const KeyPress& press) {
  const std::string name = std::exchange(rebinding_, {});
  if (press == KeyPress{GuiKey::escape, {}}) return;
  KeyBindings& keys = context_.settings.keys;
  if (press == KeyPress{GuiKey::erase, {}}) {
    keys.erase(name);
  } else if (const std::string reason = hotkeys_.conflict(name, press); !reason.empty()) {
    context_.show_notice(fmt::format("{}: {}", key_text(press), reason));
    return;
  } else {
    keys[name] = key_text(press);
  }
  hotkeys_ = Hotkeys(keys);
  for (const std::string& error : hotkeys_.errors()) context_.show_notice(error);
}

void Gui::perform(HotkeyAction action, const KeyPress& press) {
  GuiSettings& settings = context_.settings;
  const auto text_size = [&](double change) {
    settings.text_size = std::clamp(settings.text_size + change, GuiSettings::kMinTextSize, GuiSettings::kMaxTextSize);
    context_.show_notice(fmt::format("Text size {:.0f} px", settings.text_size));
  };
  const auto digit = static_cast<std::size_t>(press.key) - static_cast<std::size_t>(GuiKey::digit_1) + 1;
  switch (action) {
    case HotkeyAction::toggle_panel:
      settings.hidden = !settings.hidden;
      break;
    case HotkeyAction::toggle_help:
      context_.show_help = !context_.show_help;
      break;
    case HotkeyAction::focus_search:
      context_.requests.focus_search = true;
      break;
    case HotkeyAction::increase_text_size:
      text_size(1);
      break;
    case HotkeyAction::decrease_text_size:
      text_size(-1);
      break;
    case HotkeyAction::recall_preset:
      context_.recall(static_cast<double>(digit));
      break;
    case HotkeyAction::store_view:
      views_.store(context_, digit);
      break;
    case HotkeyAction::restore_view:
      views_.restore(context_, digit);
      actions_.push_back(action);  // ends following an object
      break;
    case HotkeyAction::move_behavior_earlier:
    case HotkeyAction::move_behavior_later:
      context_.requests.move_behavior = action == HotkeyAction::move_behavior_earlier ? -1 : 1;
      break;
    default:
      if (is_of_window(action)) {
        actions_.push_back(action);
      } else if (!frames(action)) {
        perform_in_context(action, context_);
      } else if (!wants_mouse()) {  // the pointer is over the view
        actions_.push_back(action);
      }
      break;
  }
}

// Draws the panels of a slot: side by side at the top, elsewhere as tabs.
void Gui::draw_slot(PanelSlot slot) {
  const PanelRect& rect = layout_.at(slot);
  std::vector<DockedPanel*> panels;
  for (DockedPanel& panel : panels_) {
    if ((layout_.compact ? panel.type.compact_slot : panel.type.wide_slot) == slot) panels.push_back(&panel);
  }
  if (rect.empty() || panels.empty()) return;
  std::stable_sort(panels.begin(), panels.end(),
                   [](const DockedPanel* a, const DockedPanel* b) { return a->type.order < b->type.order; });
  ImGui::SetNextWindowPos({static_cast<float>(rect.x), static_cast<float>(rect.y)});
  ImGui::SetNextWindowSize({static_cast<float>(rect.width), static_cast<float>(rect.height)});
  if (ImGui::Begin(fmt::format("##slot{}", static_cast<int>(slot)).c_str(), nullptr, kFixed)) {
    if (slot == PanelSlot::top) {
      for (DockedPanel* const panel : panels) panel->panel->draw(context_);
    } else {
      draw_tabs(static_cast<std::size_t>(slot), panels);
    }
  }
  ImGui::End();
}

// If the titles don't fit, they come closer, and then lose their badges.
void Gui::draw_tabs(std::size_t slot, const std::vector<DockedPanel*>& panels) {
  std::size_t& selected = selected_[slot];
  selected = std::min(selected, panels.size() - 1);
  std::vector<std::string> titles, short_titles;
  for (const DockedPanel* const panel : panels) {
    const std::string badge = panel->panel->badge(context_);
    short_titles.emplace_back(panel->type.title);
    titles.push_back(short_titles.back() + (badge.empty() ? "" : "  ") + badge);
  }
  TabSpacing spacing = tab_spacing(titles);
  if (!spacing.fits) {
    titles = std::move(short_titles);
    spacing = tab_spacing(titles);
  }
  for (std::size_t i = 0; i < panels.size(); i++) {
    const PanelType& type = panels[i]->type;
    if (i > 0) ImGui::SameLine(0, spacing.gap);
    if (panels.size() == 1) {
      ImGui::AlignTextToFramePadding();
      ImGui::TextUnformatted(titles[i].c_str());
      continue;
    }
    ImGui::PushStyleColor(ImGuiCol_Button,
                          packed_color(i == selected ? ThemeColor::field : ThemeColor::panel, i == selected ? 1 : 0));
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(i == selected ? ThemeColor::text : ThemeColor::secondary));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {spacing.padding, ImGui::GetStyle().FramePadding.y});
    if (ImGui::Button(fmt::format("{}###tab_{}", titles[i], type.name).c_str())) selected = i;
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(2);
    context_.names.add(fmt::format("tab:{}", type.name));
  }
  ImGui::PushID(panels[selected]->type.name.data());
  panels[selected]->panel->draw(context_);
  ImGui::PopID();
}

// Draws a line of the help. After a click the next key press is bound to the hotkey.
void Gui::draw_help_key(const Hotkey& hotkey) {
  const bool rebinding = rebinding_ == hotkey.name;
  const ImVec2 from = ImGui::GetCursorPos();
  ImGui::PushID(hotkey.name);
  const bool clicked = ImGui::Selectable("##key", rebinding);
  ImGui::PopID();
  context_.names.add(fmt::format("help:{}", hotkey.name));
  if (clicked && hotkey.key_count == 1) rebinding_ = hotkey.name;
  ImGui::SetCursorPos(from);
  draw_key_text(rebinding ? std::string("Press a key") : keys_text(hotkey, key_labels_));
  ImGui::SameLine(ImGui::GetFontSize() * 11);
  ImGui::TextUnformatted(rebinding ? "Escape cancels, Delete restores the default" : hotkey.description);
}

void Gui::draw_key_text(const std::string& keys) const {
  ImGui::PushFont(context_.fonts.code);
  ImGui::PushStyleColor(ImGuiCol_Text, packed_color(ThemeColor::accent));
  ImGui::TextUnformatted(keys.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void Gui::draw_help() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x - kHelpMargins, size.y - kHelpMargins});
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("##help", nullptr, kOverlay | ImGuiWindowFlags_AlwaysAutoResize)) {
    // reduce the spacing and then the text size if there are too many lines for the window
    constexpr float kOtherLines = 5.2F;  // the title, the mouse, two separators
    const float lines = static_cast<float>(hotkeys_.all().size()) + kOtherLines;
    const float high = std::max(ImGui::GetFontSize(), imgui::font_height(*context_.fonts.code));
    const float line_space = (size.y - kHelpMargins - 2 * ImGui::GetStyle().WindowPadding.y) / lines;
    ImGui::SetWindowFontScale(std::clamp(line_space / high, 0.5F, 1.0F));
    ImGui::TextUnformatted("Keys and mouse (click a key to change it)");
    ImGui::Separator();
    const auto line = [&](const char* keys, const char* does) {
      draw_key_text(keys);
      context_.names.add(fmt::format("help:{}", keys));
      ImGui::SameLine(ImGui::GetFontSize() * 11);
      ImGui::TextUnformatted(does);
    };
    ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
    spacing.y = std::clamp(line_space - high, 0.0F, spacing.y);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, spacing);
    for (const Hotkey& hotkey : hotkeys_.all()) draw_help_key(hotkey);
    ImGui::Separator();
    line("Drag", "Orbit the view; Shift: pan; wheel: zoom");
    line("Part", "Click: select; double click: follow; drag: pull; Ctrl: push");
    line("Drag a bar", "Set a value; Ctrl+click: type it; right click: copy its address");
    line("Tab, arrows, Enter", "Navigate and set values by keyboard");
    ImGui::PopStyleVar();
  }
  ImGui::End();
}

// Draws the mouse spring: a circle at the dragged point, a line to the mouse and the part's name.
void Gui::draw_spring(const SpringMarker& spring) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto s = static_cast<float>(context_.scale);
  const ImVec2 from{static_cast<float>(spring.x), static_cast<float>(spring.y)};
  const ImVec2 to{static_cast<float>(spring.to_x), static_cast<float>(spring.to_y)};
  list.AddCircle(from, 13 * s, packed_color(ThemeColor::accent), 32, 2 * s);
  list.AddLine(from, to, packed_color(ThemeColor::text), 1.5F * s);
  list.AddCircleFilled(to, 4 * s, packed_color(ThemeColor::text), 16);
  const ImVec2 size = ImGui::CalcTextSize(spring.name.c_str());
  const ImVec2 at{to.x + 12 * s, to.y - size.y / 2};
  list.AddRectFilled({at.x - 5 * s, at.y - 3 * s}, {at.x + size.x + 5 * s, at.y + size.y + 3 * s},
                     packed_color(ThemeColor::panel, 0.9), 4 * s);
  list.AddText(at, packed_color(ThemeColor::text), spring.name.c_str());
}

// Draws the panic banner in the middle of the view.
void Gui::draw_panic() {
  const auto x = static_cast<float>(layout_.view.x + layout_.view.width / 2);
  const auto y = static_cast<float>(layout_.view.y + 8 * context_.scale);
  ImGui::SetNextWindowPos({x, y}, 0, {0.5F, 0});
  if (ImGui::Begin("##panic", nullptr,
                   kOverlay | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                       ImGuiWindowFlags_NoFocusOnAppearing))
    ImGui::TextUnformatted("PANIC: all motion is stopped\nPress Ctrl+. again to resume");
  context_.names.add("panic.banner");
  ImGui::End();
}

void Gui::draw_notice() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto y = static_cast<float>(layout_.view.y + layout_.view.height - 8 * context_.scale);
  const auto x = static_cast<float>(layout_.view.x + layout_.view.width / 2);
  ImGui::SetNextWindowPos({std::min(x, size.x), std::min(y, size.y)}, 0, {0.5F, 1});
  if (ImGui::Begin("##notice", nullptr,
                   kOverlay | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                       ImGuiWindowFlags_NoFocusOnAppearing))
    ImGui::TextUnformatted(context_.notice.text.c_str());
  ImGui::End();
}

}  // namespace limber::panel
