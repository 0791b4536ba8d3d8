// The properties and actions of /preset.
#include "engine/presets/node.h"

namespace limber::engine {

const PropertyTable& PresetNode::table() {
  using namespace properties;
  static const PropertyTable table(
      "preset", "/preset", "",
      {
          text_from<&PresetNode::read_names>(text("names", "Names of the presets, one per line, in order.")),
          transient(readout(integer("count", 0, 0, kUnbounded, "Number of presets."))),
          transient(readout(
              number("progress", "", 1, 0, 1, "Progress of the running morph that is least advanced; 1: none runs."))),
          transient(readout(boolean("saved", true, "True if all stored presets are on the disk."))),
          invokes<&PresetNode::act_recall>(action(
              "recall", 1, 2,
              "Recalls a preset by number (or name), at once or over seconds; 2.5 blends the second and third.")),
          invokes<&PresetNode::act_stop>(action("stop", 0, 0, "Stops running morphs at their current values.")),
      });
  return table;
}

PresetNode::PresetNode(sim::World& world, Presets& presets)
    : world_(world), presets_(presets), id_(world.store().add(table(), world.store().root(), "preset", this)) {}

void PresetNode::publish() {
  Store& store = world_.store();
  store.mutable_values(id_, table().at("count"))[0] = static_cast<double>(presets_.list().size());
  store.mutable_values(id_, table().at("progress"))[0] = presets_.progress(world_);
  store.mutable_values(id_, table().at("saved"))[0] = presets_.saved() ? 1 : 0;
}

Result<void> PresetNode::act_recall(std::span<const double> args) {
  return presets_.recall_number(world_, args[0], args.size() > 1 ? args[1] : 0);
}

Result<void> PresetNode::act_stop(std::span<const double>) {
  presets_.stop();
  return {};
}

}  // namespace limber::engine
