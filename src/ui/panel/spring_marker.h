// SpringMarker: the mouse spring as the panel draws it over the view.
#pragma once

#include <string>

namespace limber::panel {

/// The dragged point and its target, in pixels, and the name of the dragged part.
struct SpringMarker {
  double x = 0, y = 0, to_x = 0, to_y = 0;
  std::string name;
};

}  // namespace limber::panel
