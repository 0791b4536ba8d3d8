// EditNode: the tree node /edit, with undo and redo. [sim]
#pragma once

#include <span>
#include <string_view>

#include "engine/edits/undo_stack.h"

namespace limber::engine {

class EditNode {
 public:
  static const PropertyTable& table();

  EditNode(sim::World& world, UndoStack& undo_stack);

 private:
  std::string_view undo_text() const { return undo_stack_.undo_text(); }
  std::string_view redo_text() const { return undo_stack_.redo_text(); }
  Result<void> undo(std::span<const double> args);
  Result<void> redo(std::span<const double> args);

  sim::World& world_;
  UndoStack& undo_stack_;
};

}  // namespace limber::engine
