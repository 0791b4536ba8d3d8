// BreedGui: the user interface of `limber breed`: nine variations side by side, and the panel with their parameters and
// the operations. It holds no variations: it shows a BreedView and returns the user's actions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ui/panel/imgui/gui_host.h"
#include "ui/panel/layout.h"
#include "ui/panel/widgets/widget_names.h"

struct ImVec2;

namespace limber::panel {

/// The content of a cell.
struct BreedCell {
  std::uint32_t texture = 0;  ///< Name of an OpenGL texture; 0: there is no image yet.
  bool liked = false;
  bool kept = false;                ///< A parent of this generation, unchanged.
  std::string preset;               ///< Name of the preset that it was stored as; empty: none.
  std::string error;                ///< Reason why it doesn't play as it should; empty: it does.
  std::vector<std::string> values;  ///< Of the parameters.
  std::vector<double> positions;    ///< Within the ranges of the parameters, 0 .. 1.
};

struct BreedParameter {
  std::string name;
  bool held = false;
};

/// The content of the window.
struct BreedView {
  static constexpr std::size_t kCells = 9;
  std::array<BreedCell, kCells> cells;
  std::vector<BreedParameter> parameters;
  std::uint64_t generation = 1;
  bool can_undo = false, can_redo = false;
  bool paused = false;
  bool following = false;  ///< The cameras follow the creatures.
  std::string notice;      ///< The latest message to the user.
  bool failed = false;     ///< The notice is an error.
};

/// An action of the user.
struct BreedAction {
  enum class Kind : std::uint8_t {
    like,
    hold,
    mutate,
    cross,
    randomize,
    undo,
    redo,
    keep,
    restart,
    pause,
    follow,
    full_screen
  };
  Kind kind = Kind::like;
  std::size_t index = 0;  ///< Of the cell or the parameter.
  double amount = 0;      ///< Of mutate.
  std::string name = {};  ///< Of keep: name of the presets; numbers are added.
};

/// [main]
class BreedGui {
 public:
  explicit BreedGui(const GuiHostOptions& options) : host_(options) {}

  void push(const InputEvent& event) { host_.push(event); }
  bool has_events() const { return host_.has_events(); }
  /// Runs one frame and returns the user's actions.
  std::vector<BreedAction> frame(const GuiFrame& frame, double text_size, const BreedView& view);
  void render() { host_.render(); }

  /// Size of the image in a cell, pixels.
  int cell_width() const { return static_cast<int>(cell_.width); }
  int cell_height() const { return static_cast<int>(cell_.height); }
  /// True while the mouse drags from a cell, or is over one: then it moves the cameras.
  bool moves_camera() const { return moves_camera_; }
  const WidgetNames& names() const { return names_; }

 private:
  struct Button {
    const char* label;
    const char* key;
    const char* name;  // of the widget
    const char* hint;
    bool enabled = true;
  };

  void handle_keys(const std::vector<KeyPress>& keys);
  static void new_frame(const std::vector<KeyPress>& keys);
  void lay_out(const GuiFrame& frame);
  void draw_cells(const BreedView& view);
  PanelRect rect_of(std::size_t index) const;
  bool handle_cell(std::size_t index);
  void draw_cell(const BreedCell& cell, std::size_t index);
  static void draw_error(const std::string& text, const ImVec2& low, const ImVec2& high);
  void draw_panel(const BreedView& view);
  void draw_operations(const BreedView& view);
  void draw_keep(const BreedView& view);
  void draw_parameters(const BreedView& view);
  void draw_parameter(const BreedView& view, std::size_t index);
  bool button(const Button& button);
  void act(BreedAction::Kind kind, std::size_t index = 0);

  GuiHost host_;
  WidgetNames names_;
  std::vector<BreedAction> actions_;
  PanelRect grid_, panel_, cell_;  // the first cell
  double gap_ = 0;                 // pixels between cells
  std::size_t shown_ = 0;          // cell whose parameters the panel shows: the last one under the mouse
  float amount_ = 0.1F;
  std::string name_ = "bred";
  bool moves_camera_ = false;
  bool dragged_ = false;  // the mouse has moved since a cell was pressed
};

}  // namespace limber::panel
