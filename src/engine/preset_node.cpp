// The rows of /preset.
#include "engine/preset_node.h"

namespace limber {

const Table& PresetNode::table() {
  using namespace rows;
  static const Table table(
      "preset", "/preset", "",
      {
          say<&PresetNode::say_names>(text("names", "Names of the presets, a line each, in their order.")),
          live(readout(integer("count", 0, 0, kUnbounded, "How many presets there are."))),
          live(readout(number("progress", "", 1, 0, 1, "How far the morph is that has most to go; 1: none runs."))),
          live(readout(boolean("saved", true, "All that was stored is on the disk."))),
          act<&PresetNode::act_recall>(action(
              "recall", 1, 2,
              "The preset of that number (or of a name), at once or over seconds; 2.5: between the second and third.")),
          act<&PresetNode::act_stop>(action("stop", 0, 0, "Running morphs stay where they are.")),
      });
  return table;
}

PresetNode::PresetNode(World& world, Presets& presets)
    : world_(world), presets_(presets), id_(world.store().add(table(), world.store().root(), "preset", this)) {}

void PresetNode::tell() {
  Store& store = world_.store();
  store.tell(id_, table().at("count"))[0] = static_cast<double>(presets_.list().size());
  store.tell(id_, table().at("progress"))[0] = presets_.part(world_);
  store.tell(id_, table().at("saved"))[0] = presets_.saved() ? 1 : 0;
}

Result<void> PresetNode::act_recall(std::span<const double> args) {
  return presets_.recall_number(world_, args[0], args.size() > 1 ? args[1] : 0);
}

Result<void> PresetNode::act_stop(std::span<const double>) {
  presets_.stop();
  return {};
}

}  // namespace limber
