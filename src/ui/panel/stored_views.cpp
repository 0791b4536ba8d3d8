// Reading and setting the camera's properties.
#include "ui/panel/stored_views.h"

#include <fmt/format.h>

#include "ui/panel/gui_context.h"

namespace limber::panel {

namespace {
constexpr const char* kEye = "/visuals/camera/eye";
constexpr const char* kTarget = "/visuals/camera/target";
}  // namespace

void StoredViews::store(GuiContext& context, std::size_t number) {
  const auto eye = context.find(kEye);
  const auto target = context.find(kTarget);
  View view;
  if (!eye || !target || !context.values(*eye, view.eye) || !context.values(*target, view.target)) return;
  views_.at(number - 1) = view;
  context.show_notice(fmt::format("View {} stored", number));
}

void StoredViews::restore(GuiContext& context, std::size_t number) const {
  const std::optional<View>& view = views_.at(number - 1);
  if (!view) return context.show_notice(fmt::format("View {0} is empty; Ctrl+Shift+{0} stores one", number));
  const auto point = [](const PendingValues::Values& v) {
    return std::vector{Arg::of(v[0]), Arg::of(v[1]), Arg::of(v[2])};
  };
  // the eye twice, because a new eye is ignored if it equals the old target
  for (const char* address : {kEye, kTarget, kEye})
    context.send(address, point(address == kEye ? view->eye : view->target));
}

}  // namespace limber::panel
