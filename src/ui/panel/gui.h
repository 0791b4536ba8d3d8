// Gui: the user interface over the view, built with Dear ImGui. Users call all of it the panel; in the code a Panel is
// one of its parts, such as the list of behaviors. It reads snapshots, sends messages and holds no simulation state. It
// draws with OpenGL, or not at all in tests. Read panel.h and property_widget.h next.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ui/panel/gui_context.h"
#include "ui/panel/hotkeys.h"
#include "ui/panel/imgui/gui_host.h"
#include "ui/panel/imgui/input.h"
#include "ui/panel/layout.h"
#include "ui/panel/panel.h"
#include "ui/panel/stored_views.h"

namespace limber::panel {

struct GuiOptions : GuiHostOptions {
  GuiSettings settings;
  std::vector<std::string> behavior_types;  ///< Types that can be added.
  std::vector<std::string> history;         ///< Console lines of earlier sessions.
  std::function<void(const std::string&)> store_line = [](const std::string&) {};  ///< Stores a console line.
  std::string scene_file;  ///< The file name that is proposed for the scene of the model that plays.
  /// Writes the scene of the model that plays to a file, which may exist only if `overwrite`; empty: no model plays.
  std::function<Result<void>(const std::string& file, bool overwrite)> save_scene;
};

class Gui {
 public:
  /// `link` must outlive it. [main]
  Gui(engine::EngineLink& link, GuiOptions options);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Queues an input event. [main]
  void push(const InputEvent& event) { host_.push(event); }
  /// True if queued events are left for further frames.
  bool has_events() const { return host_.has_events(); }
  /// Runs one frame: reads snapshots, lays out the panels, sends messages. [main]
  void frame(const GuiFrame& frame);
  /// Draws the last frame to the current OpenGL framebuffer. [main]
  void render() { host_.render(); }

  /// True if the mouse is over the panel or drags one of its widgets, so that the view must ignore it.
  bool wants_mouse() const;
  /// Sets the labels of keys on the user's keyboard, for the help. [main]
  void set_key_labels(KeyLabels labels) { key_labels_ = std::move(labels); }
  /// Returns the hotkey actions since the last call that the window must perform.
  std::vector<HotkeyAction> consume_actions();

  const WidgetNames& names() const { return context_.names; }
  const GuiSettings& settings() const { return context_.settings; }
  const Layout& layout() const { return layout_; }
  GuiContext& context() { return context_; }
  const GuiOptions& options() const { return options_; }

 private:
  struct DockedPanel {
    PanelType type;
    std::unique_ptr<Panel> panel;
  };

  void collect_name_characters();
  void handle_keys(const std::vector<KeyPress>& keys);
  void perform(HotkeyAction action, const KeyPress& press);
  void bind_key(const KeyPress& press);
  void draw_slot(PanelSlot slot);
  void draw_tabs(std::size_t slot, const std::vector<DockedPanel*>& panels);
  void draw_spring(const SpringMarker& spring) const;
  void draw_help();
  void draw_help_key(const Hotkey& hotkey);
  void draw_key_text(const std::string& keys) const;
  void draw_panic();
  void draw_notice() const;

  GuiOptions options_;
  GuiHost host_;
  GuiContext context_;
  StoredViews views_;
  Layout layout_;
  std::vector<DockedPanel> panels_;
  std::array<std::size_t, static_cast<std::size_t>(PanelSlot::count)> selected_{};  // selected tab of each slot
  std::vector<HotkeyAction> actions_;
  Hotkeys hotkeys_;
  KeyLabels key_labels_;
  std::string rebinding_;                // name of the hotkey that is being rebound; empty: none
  std::set<unsigned> extra_characters_;  // characters of names that both fonts lack
  std::shared_ptr<const TreeSnapshot> characters_tree_;
  bool characters_changed_ = false;  // extra_characters_ has changed since the fonts were built
};

}  // namespace limber::panel
