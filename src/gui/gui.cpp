// One frame of the panel.
#include "gui/gui.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_impl_opengl3.h>

#include "base/log.h"
#include "gui/imgui_versions.h"
#include "gui/theme.h"

namespace limber {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollbar |
                                    ImGuiWindowFlags_NoScrollWithMouse;  // what scrolls lies in a window within

// over the others
constexpr ImGuiWindowFlags kAbove = kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus;

void set_clipboard(void* options, const char* text) { static_cast<const GuiOptions*>(options)->copy(text); }
const char* get_clipboard(void* options) {
  static std::string pasted;
  pasted = static_cast<const GuiOptions*>(options)->paste();
  return pasted.c_str();
}

// what the desk does by itself
void act_on_show(HotkeyAction action, Desk& desk) {
  switch (action) {
    case HotkeyAction::play_pause:
      if (desk.now != nullptr) desk.send(desk.now->paused ? "/transport/play" : "/transport/pause");
      break;
    case HotkeyAction::step:
      desk.step_time(1);
      break;
    case HotkeyAction::step_back:
      desk.step_time(-1);
      break;
    case HotkeyAction::rewind:
      desk.rewind(kRewindSeconds);
      break;
    case HotkeyAction::record:
      desk.record();
      break;
    case HotkeyAction::play_take:
      desk.play_take();
      break;
    case HotkeyAction::panic:
      desk.panic();
      break;
    case HotkeyAction::reset:
      desk.send("/transport/reset");
      break;
    case HotkeyAction::undo:
      desk.undo();
      break;
    case HotkeyAction::redo:
      desk.redo();
      break;
    case HotkeyAction::overlay:
      desk.toggle_overlay();
      break;
    default:
      break;
  }
}

}  // namespace

Gui::Gui(EngineLink& link, GuiOptions options)
    : options_(std::move(options)), context_(ImGui::CreateContext()), desk_(link) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  io.ConfigInputTextCursorBlink = options_.paints;
  io.ClipboardUserData = &options_;
  io.SetClipboardTextFn = set_clipboard;
  io.GetClipboardTextFn = get_clipboard;
  io.MousePos = {-1, -1};
  imgui::start_input(io);
  files_ = find_fonts(options_.font_root);
  for (const std::string& line : files_.said) log_warning("{}", line);
  desk_.settings = options_.settings;
  hotkeys_ = Hotkeys(desk_.settings.keys);
  for (const std::string& fault : hotkeys_.faults()) log_warning("the panel's settings: {}", fault);
  desk_.copy = options_.copy;
  desk_.options = &options_;
  for (const PanelKind& kind : panel_kinds()) seats_.push_back({kind, kind.make()});
  if (options_.paints && !ImGui_ImplOpenGL3_Init(options_.glsl.c_str())) {
    log_error("the panel is not drawn: libGL.so.1 can't be loaded. On Debian: apt-get install libgl1");
    options_.paints = false;
  }
}

Gui::~Gui() {
  ImGui::SetCurrentContext(context_);
  if (options_.paints) ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void Gui::renew_fonts(const GuiFrame& frame) {
  const double scale = std::clamp(frame.display_scale, 0.5, 4.0);
  const double pixels = std::floor(desk_.settings.text_size * scale);
  if (pixels == pixels_ && !std::exchange(other_letters_, false)) return;
  pixels_ = pixels;
  desk_.scale = pixels / 16;
  desk_.fonts = load_fonts(files_, pixels, letters_);
  apply_theme(desk_.scale);
  imgui::publish_fonts(options_.paints, painted_fonts_);
}

// names may have letters that the fonts lack: those alone are taken of a third, as it has some ten thousand
void Gui::look_for_letters() {
  if (desk_.image == nullptr || desk_.image->tree == letters_of_) return;
  letters_of_ = desk_.image->tree;
  const bool had = !letters_.empty();
  for (std::uint32_t node = 0; node < letters_of_->nodes().size(); node++)
    other_letters_ = gather_letters(letters_of_->name(node), letters_) || other_letters_;
  if (!other_letters_ || !files_.others.empty()) return;
  other_letters_ = false;
  if (!had) log_warning("names have letters that no font here shows; apt-get install fonts-noto-cjk, say");
}

void Gui::frame(const GuiFrame& frame) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  renew_fonts(frame);
  io.DisplaySize = {static_cast<float>(frame.width), static_cast<float>(frame.height)};
  io.DeltaTime = static_cast<float>(std::clamp(frame.clock - last_clock_, 1e-4, 0.5));
  last_clock_ = frame.clock;
  if (options_.paints) {
    ImGui_ImplOpenGL3_NewFrame();
    painted_fonts_ = true;
  }
  const std::vector<KeyPress> keys = input_.frame();
  desk_.look(frame.clock);
  look_for_letters();
  desk_.names.clear();
  layout_ = lay_out(frame.width, frame.height, desk_.scale);
  hear_keys(keys);
  ImGui::NewFrame();
  for (const Seat& seat : seats_) seat.panel->hear(desk_);
  if (!desk_.settings.hidden && desk_.now != nullptr && desk_.image != nullptr) {
    for (std::size_t i = 0; i < layout_.slots.size(); i++) draw_slot(static_cast<Slot>(i));
  }
  if (desk_.mark) draw_mark(*desk_.mark);
  if (!desk_.settings.hidden && desk_.panicked()) draw_panic();
  if (desk_.help) draw_help();
  if (desk_.clock < desk_.notice_until) draw_notice();
  if (!ImGui::IsAnyItemActive()) desk_.let_go();
  ImGui::Render();
}

void Gui::paint() {
  ImGui::SetCurrentContext(context_);
  if (options_.paints) ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Gui::wants_mouse() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::GetIO().WantCaptureMouse;
}

std::vector<HotkeyAction> Gui::take_actions() { return std::exchange(actions_, {}); }

void Gui::hear_keys(const std::vector<KeyPress>& keys) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!desk_.help) choosing_.clear();
  for (const KeyPress& press : keys) {
    if (!choosing_.empty()) {
      choose_key(press);
      continue;
    }
    // while somebody goes about by keys, these act on what is chosen
    if (io.NavVisible && (press.key == GuiKey::space || press.key == GuiKey::home)) continue;
    const Hotkey* const hotkey = hotkeys_.of(press, io.WantTextInput);
    if (hotkey != nullptr) act(hotkey->action, press);
  }
}

// the key for the hotkey that was clicked in the help; Escape leaves it, Delete brings the first one back
void Gui::choose_key(const KeyPress& press) {
  const std::string name = std::exchange(choosing_, {});
  if (press == KeyPress{GuiKey::escape, {}}) return;
  KeyChoices& keys = desk_.settings.keys;
  if (press == KeyPress{GuiKey::erase, {}}) {
    keys.erase(name);
  } else if (const std::string why = hotkeys_.against(name, press); !why.empty()) {
    desk_.say(fmt::format("{}: {}", key_text(press), why));
    return;
  } else {
    keys[name] = key_text(press);
  }
  hotkeys_ = Hotkeys(keys);
  for (const std::string& fault : hotkeys_.faults()) desk_.say(fault);
}

void Gui::act(HotkeyAction action, const KeyPress& press) {
  PanelSettings& settings = desk_.settings;
  const auto text_size = [&](double by) {
    settings.text_size = std::clamp(settings.text_size + by, PanelSettings::kSmallestText, PanelSettings::kLargestText);
    desk_.say(fmt::format("text of {:.0f} px", settings.text_size));
  };
  const auto digit = static_cast<std::size_t>(press.key) - static_cast<std::size_t>(GuiKey::digit_1) + 1;
  switch (action) {
    case HotkeyAction::hide:
      settings.hidden = !settings.hidden;
      break;
    case HotkeyAction::help:
      desk_.help = !desk_.help;
      break;
    case HotkeyAction::search:
      desk_.focus_search = true;
      break;
    case HotkeyAction::larger:
      text_size(1);
      break;
    case HotkeyAction::smaller:
      text_size(-1);
      break;
    case HotkeyAction::recall:
      desk_.recall(static_cast<double>(digit));
      break;
    case HotkeyAction::keep_view:
      desk_.keep_view(digit);
      break;
    case HotkeyAction::go_to_view:
      desk_.go_to_view(digit);
      actions_.push_back(action);  // what is followed is followed no more
      break;
    case HotkeyAction::earlier:
    case HotkeyAction::later:
      desk_.move_behavior = action == HotkeyAction::earlier ? -1 : 1;
      break;
    case HotkeyAction::output:
    case HotkeyAction::full_screen:
    case HotkeyAction::home_view:
      actions_.push_back(action);
      break;
    default:
      act_on_show(action, desk_);
      break;
  }
}

// the panels of a slot: side by side above, elsewhere as tabs
void Gui::draw_slot(Slot slot) {
  const PanelRect& rect = layout_.at(slot);
  std::vector<Seat*> seats;
  for (Seat& seat : seats_) {
    if ((layout_.compact ? seat.kind.compact : seat.kind.wide) == slot) seats.push_back(&seat);
  }
  if (rect.empty() || seats.empty()) return;
  std::stable_sort(seats.begin(), seats.end(),
                   [](const Seat* a, const Seat* b) { return a->kind.order < b->kind.order; });
  ImGui::SetNextWindowPos({static_cast<float>(rect.x), static_cast<float>(rect.y)});
  ImGui::SetNextWindowSize({static_cast<float>(rect.width), static_cast<float>(rect.height)});
  if (ImGui::Begin(fmt::format("##slot{}", static_cast<int>(slot)).c_str(), nullptr, kFixed)) {
    if (slot == Slot::top) {
      for (Seat* const seat : seats) seat->panel->draw(desk_);
    } else {
      draw_tabs(static_cast<std::size_t>(slot), seats);
    }
  }
  ImGui::End();
}

void Gui::draw_tabs(std::size_t slot, const std::vector<Seat*>& seats) {
  std::size_t& chosen = chosen_[slot];
  chosen = std::min(chosen, seats.size() - 1);
  for (std::size_t i = 0; i < seats.size(); i++) {
    const PanelKind& kind = seats[i]->kind;
    const std::string badge = seats[i]->panel->badge(desk_);
    const std::string title = fmt::format("{}{}{}", kind.title, badge.empty() ? "" : "  ", badge);
    if (i > 0) ImGui::SameLine();
    if (seats.size() == 1) {
      ImGui::AlignTextToFramePadding();
      ImGui::TextUnformatted(title.c_str());
      continue;
    }
    ImGui::PushStyleColor(ImGuiCol_Button, packed(i == chosen ? Tone::field : Tone::panel, i == chosen ? 1 : 0));
    ImGui::PushStyleColor(ImGuiCol_Text, packed(i == chosen ? Tone::text : Tone::dim));
    if (ImGui::Button(fmt::format("{}###tab_{}", title, kind.name).c_str())) chosen = i;
    ImGui::PopStyleColor(2);
    desk_.names.note(fmt::format("tab:{}", kind.name));
  }
  ImGui::PushID(seats[chosen]->kind.name.data());
  seats[chosen]->panel->draw(desk_);
  ImGui::PopID();
}

// a line of the help: a click waits for another key
void Gui::draw_help_key(const Hotkey& hotkey) {
  const bool chooses = choosing_ == hotkey.name;
  const ImVec2 from = ImGui::GetCursorPos();
  ImGui::PushID(hotkey.name);
  const bool clicked = ImGui::Selectable("##key", chooses);
  ImGui::PopID();
  desk_.names.note(fmt::format("help:{}", hotkey.name));
  if (clicked && hotkey.keys == 1) choosing_ = hotkey.name;
  ImGui::SetCursorPos(from);
  help_keys(chooses ? std::string("press a key") : shown_keys(hotkey, key_labels_));
  ImGui::SameLine(ImGui::GetFontSize() * 11);
  ImGui::TextUnformatted(chooses ? "Escape: as it was; Delete: as at first" : hotkey.does);
}

void Gui::help_keys(const std::string& keys) const {
  ImGui::PushFont(desk_.fonts.code);
  ImGui::PushStyleColor(ImGuiCol_Text, packed(Tone::accent));
  ImGui::TextUnformatted(keys.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void Gui::draw_help() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x - 16, size.y - 16});
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("##help", nullptr, kAbove | ImGuiWindowFlags_AlwaysAutoResize)) {
    // closer together, then smaller, where there are too many lines for the window
    const float lines = static_cast<float>(hotkeys_.all().size()) + 7;
    const float high = std::max(ImGui::GetFontSize(), imgui::font_height(*desk_.fonts.code));
    const float room = (size.y - 16 - 2 * ImGui::GetStyle().WindowPadding.y) / lines;
    ImGui::SetWindowFontScale(std::clamp(room / high, 0.5F, 1.0F));
    ImGui::TextUnformatted("Keys and hands (a click on a key chooses another)");
    ImGui::Separator();
    const auto line = [&](const char* keys, const char* does) {
      help_keys(keys);
      desk_.names.note(fmt::format("help:{}", keys));
      ImGui::SameLine(ImGui::GetFontSize() * 11);
      ImGui::TextUnformatted(does);
    };
    ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
    spacing.y = std::clamp(room - high, 0.0F, spacing.y);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, spacing);
    for (const Hotkey& hotkey : hotkeys_.all()) draw_help_key(hotkey);
    ImGui::Separator();
    line("drag", "turn the view; Shift: shift it; wheel: nearer, further");
    line("a part", "click: choose; twice: follow; drag: pull; Ctrl: push");
    line("drag a bar", "set a value; Ctrl and click: type it; right click: copy its address");
    line("Tab, arrows, Enter", "go about and set values by keys");
    ImGui::PopStyleVar();
  }
  ImGui::End();
}

// a ring at what is held, a line to the hand, its name
void Gui::draw_mark(const Desk::Mark& mark) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto s = static_cast<float>(desk_.scale);
  const ImVec2 from{static_cast<float>(mark.x), static_cast<float>(mark.y)};
  const ImVec2 to{static_cast<float>(mark.to_x), static_cast<float>(mark.to_y)};
  list.AddCircle(from, 13 * s, packed(Tone::accent), 32, 2 * s);
  list.AddLine(from, to, packed(Tone::text), 1.5F * s);
  list.AddCircleFilled(to, 4 * s, packed(Tone::text), 16);
  const ImVec2 size = ImGui::CalcTextSize(mark.name.c_str());
  const ImVec2 at{to.x + 12 * s, to.y - size.y / 2};
  list.AddRectFilled({at.x - 5 * s, at.y - 3 * s}, {at.x + size.x + 5 * s, at.y + size.y + 3 * s},
                     packed(Tone::panel, 0.9), 4 * s);
  list.AddText(at, packed(Tone::text), mark.name.c_str());
}

// over the picture, where it can't be overlooked
void Gui::draw_panic() {
  const auto x = static_cast<float>(layout_.free.x + layout_.free.width / 2);
  const auto y = static_cast<float>(layout_.free.y + 8 * desk_.scale);
  ImGui::SetNextWindowPos({x, y}, 0, {0.5F, 0});
  if (ImGui::Begin(
          "##panic", nullptr,
          kAbove | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing))
    ImGui::TextUnformatted("PANIC: everything comes to rest\nCtrl+. once more: the show goes on");
  desk_.names.note("panic.banner");
  ImGui::End();
}

void Gui::draw_notice() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto y = static_cast<float>(layout_.free.y + layout_.free.height - 8 * desk_.scale);
  const auto x = static_cast<float>(layout_.free.x + layout_.free.width / 2);
  ImGui::SetNextWindowPos({std::min(x, size.x), std::min(y, size.y)}, 0, {0.5F, 1});
  if (ImGui::Begin(
          "##notice", nullptr,
          kAbove | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing))
    ImGui::TextUnformatted(desk_.notice.c_str());
  ImGui::End();
}

}  // namespace limber
