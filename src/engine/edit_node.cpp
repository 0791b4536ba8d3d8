// The rows of /edit.
#include "engine/edit_node.h"

namespace limber {

const Table& EditNode::table() {
  using namespace rows;
  static const Table table(
      "edit", "/edit", "",
      {
          say<&EditNode::say_undo>(text("undo_of", "What undo would take back, and who set it; empty: nothing.")),
          say<&EditNode::say_redo>(text("redo_of", "What redo would do again, and who set it; empty: nothing.")),
          act<&EditNode::act_undo>(
              action("undo", 0, 0, "Values are what they were before the newest step, whichever hand made it.")),
          act<&EditNode::act_redo>(action("redo", 0, 0, "The step that was undone last is done again.")),
      });
  return table;
}

EditNode::EditNode(World& world, Edits& edits) : world_(world), edits_(edits) {
  world.store().add(table(), world.store().root(), "edit", this);
}

Result<void> EditNode::act_undo(std::span<const double>) { return edits_.undo(world_); }
Result<void> EditNode::act_redo(std::span<const double>) { return edits_.redo(world_); }

}  // namespace limber
