// WidgetNames: where each widget of the last frame was, by name, so that a test drives a widget by its name and looks
// whether anything lies over anything.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gui/layout.h"

namespace limber {

struct NamedWidget {
  std::string name;
  PanelRect whole;    ///< As it lies in its panel, seen or scrolled out of sight.
  PanelRect visible;  ///< What of it is seen; empty: nothing.
  std::uint32_t window = 0;
};

class WidgetNames {
 public:
  void clear() { count_ = 0; }
  /// The item that was made last.
  void note(std::string_view name);
  /// Null: there is none in this frame.
  const NamedWidget* find(std::string_view name) const;
  /// In the order in which they were made.
  std::vector<NamedWidget> all() const {
    return {widgets_.begin(), widgets_.begin() + static_cast<std::ptrdiff_t>(count_)};
  }

 private:
  std::vector<NamedWidget> widgets_;  // their texts' memory is used again
  std::size_t count_ = 0;
};

}  // namespace limber
