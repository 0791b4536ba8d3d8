// StoredViews: views of the camera that the user stores by number.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "ui/panel/pending_values.h"

namespace limber::panel {

class GuiContext;

/// Numbers are from 1 to 9. The views are kept until the window is closed. [main]
class StoredViews {
 public:
  /// Stores the camera's current view.
  void store(GuiContext& context, std::size_t number);
  /// Sets the camera to the stored view. If there is none, a notice says so.
  void restore(GuiContext& context, std::size_t number) const;

 private:
  struct View {
    PendingValues::Values eye{}, target{};
  };
  std::array<std::optional<View>, 9> views_;
};

}  // namespace limber::panel
