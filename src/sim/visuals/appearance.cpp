// Appearance: its properties. The numbers are factors on the style's values, so that they mean the same in each style.
#include "sim/visuals/appearance.h"

namespace limber::sim {

const PropertyTable& Appearance::table() {
  using namespace properties;
  static const PropertyTable table(
      "look", "/visuals/look", "",
      {
          choice("style", {"stage", "studio"}, 0,
                 "A dark stage with a spotlight and a mirroring floor, or a bright studio. The values below are "
                 "factors on those of the style."),
          number("exposure", "", 1, 0, 16, "Brightness of the view; highlights are compressed towards white."),
          number("ambient", "", 1, 0, 10, "Ambient light, in the background's tint."),
          number("lamp", "", 1, 0, 10, "The one lamp that casts shadows."),
          number("rim", "", 1, 0, 10, "Light from behind, along the edges of shapes."),
          number("shadow", "", 1, 0, 1, "Darkness of shadows; 0: none."),
          number("fog", "", 1, 0, 10, "Density of the fog that fades distant objects into the background."),
          number("grid", "", 1, 0, 10, "Visibility of the grid on the floor, one line per meter."),
          number("mirror", "", 1, 0, 3, "Reflectivity of the floor; the studio's has none."),
          boolean("floor", true, "A floor at height 0, unless the scene has a plane there."),
          transient(state(boolean("overlay", false,
                                  "Shows joint axes and limits, centers of mass, forces, contacts and targets."))),
          invokes<&Appearance::act_prefer>(
              action("prefer", 1, 1, "Sets the style (0: stage, 1: studio), unless the scene has set it.")),
      });
  return table;
}

Result<void> Appearance::act_prefer(std::span<const double> args) {
  const Property& style = table().at("style");
  if ((store_.explicitly_set(id_) >> style.index & 1u) != 0) return {};
  if (const Result<SetOutcome> set = store_.set(id_, style, args); !set) return Error{set.error()};
  return {};
}

}  // namespace limber::sim
