// WidgetNames: the positions of the last frame's widgets by name, so that tests can use widgets by name and detect
// overlaps.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ui/panel/layout.h"

namespace limber::panel {

struct NamedWidget {
  std::string name;
  PanelRect rect;     ///< Its rectangle, even if it is scrolled out of view.
  PanelRect visible;  ///< The visible part; empty: none.
  std::uint32_t window = 0;
};

class WidgetNames {
 public:
  void clear() { count_ = 0; }
  /// Registers the last item under this name.
  void add(std::string_view name);
  /// Returns null if there is no such widget in this frame.
  const NamedWidget* find(std::string_view name) const;
  /// In the order of registration.
  std::vector<NamedWidget> all() const {
    return {widgets_.begin(), widgets_.begin() + static_cast<std::ptrdiff_t>(count_)};
  }

 private:
  std::vector<NamedWidget> widgets_;  // not cleared, so that the memory of the strings is reused
  std::size_t count_ = 0;
};

}  // namespace limber::panel
