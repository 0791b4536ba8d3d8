// Preset: a named copy of chosen values by the paths of their things. Finished, it is never changed; the live world is
// not needed to read it, mix it or write it down. [any]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "params/table.h"

namespace limber {

/// A row in a preset, known by its name and by what its values look like.
struct PresetRow {
  std::string name;
  RowType type = RowType::number;   ///< number, boolean, choice, vec3, flags3, quat; none: other numbers in a row.
  std::uint32_t width = 1;          ///< Numbers.
  std::vector<std::string> labels;  ///< Of a choice: what its number means.
  bool operator==(const PresetRow&) const = default;
};

/// The rows that several things of a preset have alike.
struct PresetClass {
  std::vector<PresetRow> rows;
  std::vector<std::uint32_t> offsets;  ///< Where each row begins in a thing's numbers.
  std::uint32_t width = 0;

  void add(PresetRow row) {
    offsets.push_back(width);
    width += row.width;
    rows.push_back(std::move(row));
  }
  /// The row of that name, or -1.
  int find(std::string_view name) const;
  bool operator==(const PresetClass& other) const { return rows == other.rows; }
};

/// Which things a preset tells of and where their numbers stand; presets that tell of the same share one.
class PresetShape {
 public:
  static constexpr std::uint32_t kNoRows = UINT32_MAX;
  struct Thing {
    std::uint32_t parent = 0;
    std::uint32_t rows = kNoRows;  ///< Its class.
    std::uint32_t at = 0;          ///< Its first number.
    std::uint32_t name_at = 0;
    std::uint32_t name_size = 0;
  };

  PresetShape() : things_(1) {}

  /// Parents first; the first is the root. Those without rows only lead to others.
  const std::vector<Thing>& things() const { return things_; }
  const std::vector<std::shared_ptr<const PresetClass>>& classes() const { return classes_; }
  const PresetClass* rows(const Thing& thing) const {
    return thing.rows == kNoRows ? nullptr : classes_[thing.rows].get();
  }
  std::string_view name(const Thing& thing) const {
    return std::string_view(names_).substr(thing.name_at, thing.name_size);
  }
  /// "/physics/body/my%20arm".
  std::string path(std::uint32_t thing) const;
  std::uint32_t width() const { return width_; }
  /// Of a thing or, where it has none, of the first below it that has; of a shape like add_all() takes.
  std::uint32_t first_number(std::uint32_t thing) const;
  std::size_t row_count() const;
  bool operator==(const PresetShape& other) const;

  // for those who make one
  /// There will be so many things.
  void expect(std::size_t things);
  std::uint32_t add(std::uint32_t parent, std::string_view name);
  /// Gives the thing rows; their numbers stand behind all that were given so far.
  void give(std::uint32_t thing, std::uint32_t rows);
  std::uint32_t add_class(std::shared_ptr<const PresetClass> rows);
  /// A thing of another shape, which has these classes, and all below it; those of `from` stand parents first, each
  /// with what is below it, and were given their rows in that order. The answer: its number here.
  std::uint32_t add_all(const PresetShape& from, std::uint32_t thing, std::uint32_t parent);

 private:
  std::vector<Thing> things_;
  std::vector<std::shared_ptr<const PresetClass>> classes_;
  std::string names_;
  std::uint32_t width_ = 0;
};

/// What a preset is made of.
struct PresetChoice {
  std::vector<std::string> rows;    ///< Patterns of what is kept; none: every property.
  std::vector<std::string> except;  ///< Patterns of what a recall leaves alone.
  bool poses = false;               ///< With where every part is.
  bool velocities = false;          ///< With how it moves.
  bool operator==(const PresetChoice&) const = default;
};

struct Preset {
  std::string name;
  PresetChoice choice;
  std::shared_ptr<const PresetShape> shape;
  std::vector<double> values;  ///< shape->width() of them.
};

using PresetList = std::vector<std::shared_ptr<const Preset>>;

/// A preset, or what lies between two that share their shape.
struct Blend {
  std::shared_ptr<const Preset> a, b;
  double amount = 0;

  static Blend of(const std::shared_ptr<const Preset>& preset) { return {preset, preset, 0}; }
};

/// Two presets cut down to the rows that both have, with one shape.
Blend aligned(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b);

/// Makes a preset thing by thing, of texts.
class PresetBuilder {
 public:
  PresetBuilder() : shape_(std::make_shared<PresetShape>()) {}

  /// The thing of that path, which begins with /. It may be there already.
  std::uint32_t thing(std::string_view path);
  bool has_rows(std::uint32_t thing) const { return shape_->things()[thing].rows != PresetShape::kNoRows; }
  /// Gives the thing these rows with their numbers. Once only.
  void give(std::uint32_t thing, PresetClass rows, const std::vector<double>& values);
  std::shared_ptr<const Preset> finish(std::string name, PresetChoice choice);

 private:
  std::shared_ptr<PresetShape> shape_;
  std::vector<double> values_;
  std::unordered_map<std::string, std::uint32_t> things_;   // by parent and name
  std::unordered_map<std::string, std::uint32_t> classes_;  // by all that is in them
};

}  // namespace limber
