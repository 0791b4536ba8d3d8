// Gui: the panel over the picture, on Dear ImGui. Read panel.h and property_widget.h next. It sees images and
// snapshots, sends messages, and keeps nothing of the world. With a painter that draws through OpenGL, or none for
// tests.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "gui/desk.h"
#include "gui/hotkeys.h"
#include "gui/input.h"
#include "gui/layout.h"
#include "gui/panel.h"

struct ImGuiContext;

namespace limber {

struct GuiOptions {
  bool paints = true;                      ///< Through OpenGL, in the context that is current; false: nothing is drawn.
  std::string glsl = "#version 330 core";  ///< First line of its shaders, as the context wants it.
  std::string font_root = "/";
  PanelSettings settings;
  std::vector<std::string> behavior_types;  ///< What may be added.
  std::vector<std::string> history;         ///< Lines that were typed into consoles before.
  std::function<void(const std::string&)> remember = [](const std::string&) {};  ///< One more of them.
  std::function<void(const std::string&)> copy = [](const std::string&) {};      ///< To the clipboard.
  std::function<std::string()> paste = [] { return std::string(); };
};

/// The picture that a frame of the panel lies over.
struct GuiFrame {
  double width = 0;  ///< Pixels.
  double height = 0;
  double display_scale = 1;  ///< Of the screen: 2 on one with twice the pixels.
  double clock = 0;          ///< s; rising.
};

class Gui {
 public:
  /// `link` outlives it. [main]
  Gui(EngineLink& link, GuiOptions options);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// What a hand has done, in order. [main]
  void push(const InputEvent& event) { input_.push(event); }
  /// Events that wait for frames of their own.
  bool has_events() const { return !input_.empty(); }
  /// One frame: hears, lays out, sends. [main]
  void frame(const GuiFrame& frame);
  /// Draws the last frame into what OpenGL is bound to. [main]
  void paint();

  /// The mouse is over the panel or has hold of something there: nothing for the picture.
  bool wants_mouse() const;
  /// What the keyboard prints on keys, for the help. [main]
  void key_labels(KeyLabels labels) { key_labels_ = std::move(labels); }
  /// Actions of hotkeys that are the window's to do, since the last call.
  std::vector<HotkeyAction> take_actions();

  const WidgetNames& names() const { return desk_.names; }
  const PanelSettings& settings() const { return desk_.settings; }
  const Layout& layout() const { return layout_; }
  Desk& desk() { return desk_; }
  const GuiOptions& options() const { return options_; }

 private:
  struct Seat {
    PanelKind kind;
    std::unique_ptr<Panel> panel;
  };

  void renew_fonts(const GuiFrame& frame);
  void look_for_letters();
  void hear_keys(const std::vector<KeyPress>& keys);
  void act(HotkeyAction action, const KeyPress& press);
  void choose_key(const KeyPress& press);
  void draw_slot(Slot slot);
  void draw_tabs(std::size_t slot, const std::vector<Seat*>& seats);
  void draw_mark(const Desk::Mark& mark) const;
  void draw_help();
  void draw_help_key(const Hotkey& hotkey);
  void help_keys(const std::string& keys) const;
  void draw_panic();
  void draw_notice() const;

  GuiOptions options_;
  ImGuiContext* context_;
  Desk desk_;
  InputQueue input_;
  Layout layout_;
  FontFiles files_;
  std::vector<Seat> seats_;
  std::array<std::size_t, static_cast<std::size_t>(Slot::count)> chosen_{};  // tab of each slot
  std::vector<HotkeyAction> actions_;
  Hotkeys hotkeys_;
  KeyLabels key_labels_;
  std::string choosing_;        // name of the hotkey that gets the next key; empty: none
  double pixels_ = 0;           // of the fonts
  std::set<unsigned> letters_;  // of names, that the two fonts lack
  std::shared_ptr<const Tree> letters_of_;
  bool other_letters_ = false;  // since the fonts were made
  double last_clock_ = 0;
  bool painted_fonts_ = false;
};

}  // namespace limber
