// PresetPlan: which numbers of the store are a preset, and where they stand in it. That of every property is found by a
// walk over the store, a little at a time where that is wanted; that of a choice is found in it, without another look
// at the things. [sim]
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/result.h"
#include "engine/preset.h"
#include "params/store.h"

namespace limber {

struct PresetPlan {
  struct Piece {  // numbers that stand side by side in the store and in the preset
    std::uint32_t from = 0;
    std::uint32_t count = 0;
    bool live = false;
    std::uint32_t at = 0;  // in the preset
  };
  PresetChoice choice;
  std::shared_ptr<const PresetShape> shape;
  std::vector<Piece> pieces;

  /// What `choice` names of a plan of every property, which holds: nothing has come or gone since. Errors: a pattern
  /// that is none, is too much work, or reaches no property.
  static Result<PresetPlan> of_choice(const Store& store, const PresetPlan& every, const PresetChoice& choice);

 private:
  friend class PresetPlanning;
  // some rows of a class, as a thing that has them gives them
  struct Cut {
    const Table* table = nullptr;
    std::uint64_t rows = 0;
    std::uint32_t number = 0;   // of the shape's class
    std::vector<Piece> pieces;  // from where the thing's own numbers begin
  };
  class Things;
  class Choosing;

  const Cut& cut_of(PresetShape& shape, const Table& table, std::uint64_t rows);
  void take(const Cut& cut, const NodeSlot& slot, std::uint32_t at);
  void append(const Piece& piece) { append(piece, pieces); }
  static void append(const Piece& piece, std::vector<Piece>& pieces);

  std::uint64_t structure_ = 0;                                 // the store's
  std::vector<NodeId> nodes_;                                   // of the shape's things
  std::map<std::pair<const Table*, std::uint64_t>, Cut> cuts_;  // the shape's classes
  const Cut* last_cut_ = nullptr;                               // neighbours are alike
};

/// The walk to a plan of every property.
class PresetPlanning {
 public:
  /// `before`: such a plan from when less had come or gone, or null; it stays until this is finished.
  PresetPlanning(const Store& store, const PresetPlan* before);
  /// Looks at so many things; true: at all of them.
  bool go(std::size_t count);
  PresetPlan finish();
  static PresetPlan make(const Store& store, const PresetPlan* before);

 private:
  // what a class may give
  struct Kind {
    std::uint64_t rows = 0;
    std::vector<const Row*> picky;  // of these some things take none: the mass of a part that never moves
  };
  const Kind& kind_of(const Table& table);
  void add(NodeId id);
  void keep(NodeId id);
  void keep_pieces(std::uint32_t from, std::uint32_t to, std::uint32_t count);
  std::uint32_t thing(NodeId id);

  const Store& store_;
  const PresetPlan* before_;
  std::vector<std::uint32_t> before_things_;  // by slot
  PresetPlan plan_;
  std::shared_ptr<PresetShape> shape_ = std::make_shared<PresetShape>();
  std::unordered_map<const Table*, Kind> kinds_;
  std::pair<const Table*, const Kind*> last_kind_{};  // neighbours are alike
  std::vector<std::uint32_t> things_;                 // by slot
  std::vector<NodeId> way_;                           // to be looked at, the next one last
};

}  // namespace limber
