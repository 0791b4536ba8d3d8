// The rows of /take.
#include "engine/take_node.h"

namespace limber {

const Table& TakeNode::table() {
  using namespace rows;
  static const Table table(
      "take", "/take", "",
      {
          say<&TakeNode::say_name>(text("name", "Of the take that is recorded, or replayed; empty: there is none.")),
          live(readout(boolean("replays", false, "It is replayed; hands have no effect then."))),
          live(readout(integer("ticks", 0, 0, kUnbounded, "How many it has so far; of a replay: how far that is."))),
          live(readout(integer("whole", 0, 0, kUnbounded, "How many ticks the take has that is replayed."))),
          live(readout(boolean("plays", false, "It plays in the place of a show; /take/stop brings the hands back."))),
      });
  return table;
}

TakeNode::TakeNode(World& world) : world_(world), id_(world.store().add(table(), world.store().root(), "take", this)) {}

void TakeNode::tell(const Told& told) {
  if (name_ != told.name) name_ = told.name;
  static const Row& first = table().at("replays");
  double* const out = world_.store().tell(id_, first);  // the readouts stand in a row
  out[0] = told.replays ? 1 : 0;
  out[1] = static_cast<double>(told.ticks);
  out[2] = static_cast<double>(told.whole);
  out[3] = told.plays ? 1 : 0;
}

}  // namespace limber
