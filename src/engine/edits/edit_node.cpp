// The properties of /edit.
#include "engine/edits/edit_node.h"

namespace limber::engine {

const PropertyTable& EditNode::table() {
  using namespace properties;
  static const PropertyTable table(
      "edit", "/edit", "",
      {
          text_from<&EditNode::undo_text>(
              text("undo_of", "The change that undo would revert, and its source; empty: none.")),
          text_from<&EditNode::redo_text>(
              text("redo_of", "The change that redo would apply again, and its source; empty: none.")),
          invokes<&EditNode::undo>(action("undo", 0, 0, "Reverts the newest step, regardless of its source.")),
          invokes<&EditNode::redo>(action("redo", 0, 0, "Applies the step again that was undone last.")),
      });
  return table;
}

EditNode::EditNode(sim::World& world, UndoStack& undo_stack) : world_(world), undo_stack_(undo_stack) {
  world.store().add(table(), world.store().root(), "edit", this);
}

Result<void> EditNode::undo(std::span<const double>) { return undo_stack_.undo(world_); }
Result<void> EditNode::redo(std::span<const double>) { return undo_stack_.redo(world_); }

}  // namespace limber::engine
