// The rows of a look. All but the first are multiples of what the style has, so that they mean the same in each.
#include "sim/look.h"

namespace limber {

const Table& Look::table() {
  using namespace rows;
  static const Table table(
      "look", "/visuals/look", "",
      {
          choice(
              "style", {"stage", "studio"}, 0,
              "A dark stage with a spotlight and a mirroring floor, or a bright studio. The rows below are multiples "
              "of what it has."),
          number("exposure", "", 1, 0, 16, "How bright the picture is; what is too bright turns white softly."),
          number("ambient", "", 1, 0, 10, "Light from everywhere, in the background's tint."),
          number("lamp", "", 1, 0, 10, "The one lamp that casts shadows."),
          number("rim", "", 1, 0, 10, "Light from behind, along the edges of shapes."),
          number("shadow", "", 1, 0, 1, "How dark shadows are; 0: none."),
          number("fog", "", 1, 0, 10, "How soon distance turns into background."),
          number("grid", "", 1, 0, 10, "How plain the lines on the floor are, a metre apart."),
          number("mirror", "", 1, 0, 3, "How much the floor mirrors; the studio's does not."),
          boolean("floor", true, "A floor at height 0, where no plane of the scene is one."),
          live(
              state(boolean("overlay", false,
                            "Joint axes and limits, centres of mass, forces, contacts and targets over the picture."))),
          act<&Look::act_prefer>(action(
              "prefer", 1, 1, "A style by its number (0: stage, 1: studio), unless the scene says which one it has.")),
      });
  return table;
}

Result<void> Look::act_prefer(std::span<const double> args) {
  const Row& style = table().at("style");
  if ((store_.said(id_) >> style.index & 1u) != 0) return {};
  if (const Result<SetOutcome> set = store_.set(id_, style, args); !set) return Error{set.error()};
  return {};
}

}  // namespace limber
