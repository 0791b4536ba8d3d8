// The properties of /take.
#include "engine/takes/take_node.h"

namespace limber::engine {

const PropertyTable& TakeNode::table() {
  using namespace properties;
  static const PropertyTable table(
      "take", "/take", "",
      {
          text_from<&TakeNode::read_name>(
              text("name", "Name of the take that is being recorded or replayed; empty: none.")),
          transient(readout(boolean("replays", false, "A take is being replayed; messages are rejected."))),
          transient(readout(integer("ticks", 0, 0, kUnbounded, "Ticks recorded or replayed so far."))),
          transient(readout(integer("whole", 0, 0, kUnbounded, "Number of ticks of the take that is being replayed."))),
          transient(readout(boolean("plays", false, "A take plays in the running session; /take/stop ends it."))),
      });
  return table;
}

TakeNode::TakeNode(sim::World& world)
    : world_(world), id_(world.store().add(table(), world.store().root(), "take", this)) {}

void TakeNode::publish(const Status& status) {
  if (name_ != status.name) name_ = status.name;
  static const Property& first = table().at("replays");
  double* const out = world_.store().mutable_values(id_, first);  // the readouts are contiguous
  out[0] = status.replaying ? 1 : 0;
  out[1] = static_cast<double>(status.ticks);
  out[2] = static_cast<double>(status.total_ticks);
  out[3] = status.in_session ? 1 : 0;
}

}  // namespace limber::engine
