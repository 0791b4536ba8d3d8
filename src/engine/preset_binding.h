// PresetBinding: where the rows of a preset are in the live world, by the names of things and rows. What went, what is
// of another type and what the preset leaves alone is left out. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/preset.h"
#include "params/store.h"

namespace limber {

class PresetBinding {
 public:
  /// A preset's row that its thing's class still has.
  struct FitRow {
    const Row* row = nullptr;
    const PresetRow* from = nullptr;
    std::uint32_t at = 0;         ///< In the thing's numbers.
    std::vector<double> choices;  ///< Of a choice: the row's number for each of the preset's labels; −1: it has none.
  };
  struct Fit {
    const PresetClass* from = nullptr;
    const Table* table = nullptr;
    std::vector<FitRow> rows;
    std::vector<std::uint32_t> poorer;  ///< Of rows, those that have not every label of the preset's.
    std::string misfit;                 ///< The name of the first row that did not fit.
    std::size_t misfits = 0;
  };
  struct Thing {
    NodeId id;
    std::uint32_t number = 0;      ///< Among the shape's things.
    std::uint32_t fit = 0;         ///< Among the fits.
    std::uint32_t at = 0;          ///< Its first number.
    std::uint64_t left_alone = 0;  ///< Rows of its class, a bit a row.
  };

  /// Errors: an `except` that is no pattern.
  static Result<std::shared_ptr<const PresetBinding>> make(const Store& store, std::shared_ptr<const PresetShape> shape,
                                                           std::span<const std::string> except, bool tells_of_all);

  /// Whether it still holds.
  bool holds(const Store& store) const { return structure_ == store.structure_version(); }
  const std::shared_ptr<const PresetShape>& shape() const { return shape_; }
  const std::vector<std::string>& except() const { return except_; }
  /// Group behaviours first, since what is written to them goes to their members; then in the shape's order.
  const std::vector<Thing>& things() const { return things_; }
  const Fit& fit(const Thing& thing) const { return fits_[thing.fit]; }
  /// What was left out because it came or went: empty, or "2 things are gone (/physics/body/arm, …); …".
  const std::string& left_out() const { return left_out_; }

  /// The row's numbers in a preset of this shape; false: a label that the row does not have.
  static bool read(const FitRow& row, const double* values, double* out);

 private:
  class Making;

  std::uint64_t structure_ = 0;
  std::shared_ptr<const PresetShape> shape_;
  std::vector<std::string> except_;
  std::vector<Thing> things_;
  std::vector<Fit> fits_;
  std::string left_out_;
};

}  // namespace limber
