// EditNode: undo and redo in the tree, at /edit. [sim]
#pragma once

#include <span>
#include <string_view>

#include "engine/edits.h"

namespace limber {

class EditNode {
 public:
  static const Table& table();

  EditNode(World& world, Edits& edits);

 private:
  std::string_view say_undo() const { return edits_.undo_text(); }
  std::string_view say_redo() const { return edits_.redo_text(); }
  Result<void> act_undo(std::span<const double> args);
  Result<void> act_redo(std::span<const double> args);

  World& world_;
  Edits& edits_;
};

}  // namespace limber
