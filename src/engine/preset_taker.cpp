// A walk over the store for a plan; along the plan for a preset.
#include "engine/preset_taker.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "params/catalog.h"
#include "sim/part.h"

namespace limber {

namespace {

constexpr std::size_t kMostPlans = 8;

PresetRow preset_row(const Row& row) {
  const RowType type = row.type == RowType::integer ? RowType::number : row.type;
  return {row.name, type, row.width, row.choices};
}

}  // namespace

class PresetTaker::Planning {
 public:
  Planning(const Store& store, const PresetChoice& choice) : store_(store) { plan_.choice = choice; }

  Result<Plan> make() {
    const PresetChoice& choice = plan_.choice;
    if (const Result<void> chosen = choose(); !chosen) return Error{chosen.error()};
    things_.assign(store_.view()->slot_count, 0);
    store_.walk(store_.root(), [&](NodeId id) { add(id); });
    if (!choice.rows.empty() && shape_->row_count() == 0)
      return Error{fmt::format("'{}' reaches no property", printable(fmt::format("{}", fmt::join(choice.rows, " "))))};
    plan_.structure = store_.structure_version();
    plan_.shape = shape_;
    return std::move(plan_);
  }

 private:
  // rows by slot, of those that the patterns reach
  Result<void> choose() {
    for (const std::string& pattern : plan_.choice.rows) {
      PatternBudget budget;
      const Result<std::vector<Place>> places = match_places(store_, pattern, budget);
      if (!places) return Error{places.error()};
      for (const Place& place : *places) {
        // a thing stands for all that it has, and for what is in it
        if (place.row == nullptr)
          store_.walk(place.node, [&](NodeId id) { choose(id, ~std::uint64_t{0}); });
        else
          choose(place.node, std::uint64_t{1} << place.row->index);
      }
    }
    return {};
  }

  void choose(NodeId id, std::uint64_t rows) {
    chosen_[id.slot] |= rows;
    part_chosen_ |= &store_.table(id) == &Part::table();
  }

  // what a class may give: properties, and of parts the states that are asked for
  std::uint64_t eligible(const Table& table) {
    const auto [known, fresh] = eligible_.try_emplace(&table, 0);
    if (!fresh) return known->second;
    const PresetChoice& choice = plan_.choice;
    for (const Row& row : table.rows()) {
      const bool pose = row.name == "position" || row.name == "rotation";
      const bool motion = row.name == "linear_velocity" || row.name == "angular_velocity";
      const bool wanted = row.kind == RowKind::property || (&table == &Part::table() && row.kind == RowKind::state &&
                                                            ((pose && choice.poses) || (motion && choice.velocities)));
      if (wanted && row.stored()) known->second |= std::uint64_t{1} << row.index;
    }
    return known->second;
  }

  void add(NodeId id) {
    const Table& table = store_.table(id);
    std::uint64_t rows = eligible(table);
    if (rows != 0 && !plan_.choice.rows.empty()) {
      const auto chosen = chosen_.find(id.slot);
      // where parts are is asked for by its own word: of the parts that the patterns reach, else of all
      const bool with_states = chosen != chosen_.end() || !part_chosen_;
      const std::uint64_t states = with_states ? rows & ~properties(table) : 0;
      rows = (chosen == chosen_.end() ? 0 : rows & chosen->second) | states;
    }
    // what this thing can't take: the mass of a part that never moves
    for (std::uint64_t left = rows; left != 0; left &= left - 1) {
      const Row& row = table.row(static_cast<std::uint32_t>(std::countr_zero(left)));
      if (row.refuse != nullptr && !row.refuse(store_.thing(id), store_.values(id, row)))
        rows &= ~(std::uint64_t{1} << row.index);
    }
    if (rows == 0) return;
    shape_->give(thing(id), class_of(table, rows));
    const NodeSlot& slot = store_.view()->slots[id.slot];
    for (std::uint64_t left = rows; left != 0; left &= left - 1) {
      const Row& row = table.row(static_cast<std::uint32_t>(std::countr_zero(left)));
      append({(row.live ? slot.live : slot.kept) + row.offset, row.width, row.live});
    }
  }

  static std::uint64_t properties(const Table& table) {
    std::uint64_t rows = 0;
    for (const Row& row : table.rows()) rows |= std::uint64_t{row.kind == RowKind::property} << row.index;
    return rows;
  }

  void append(const Piece& piece) {
    std::vector<Piece>& pieces = plan_.pieces;
    const bool joins =
        !pieces.empty() && pieces.back().live == piece.live && pieces.back().from + pieces.back().count == piece.from;
    if (joins) {
      pieces.back().count += piece.count;
    } else {
      pieces.push_back(piece);
    }
  }

  std::uint32_t thing(NodeId id) {
    if (id == store_.root()) return 0;
    std::uint32_t& known = things_[id.slot];
    if (known == 0) {
      const std::uint32_t parent = thing(store_.parent(id));
      known = shape_->add(parent, store_.name(id));
    }
    return known;
  }

  std::uint32_t class_of(const Table& table, std::uint64_t rows) {
    const auto [known, fresh] = classes_.try_emplace({&table, rows}, 0);
    if (!fresh) return known->second;
    auto made = std::make_shared<PresetClass>();
    for (const Row& row : table.rows()) {
      if ((rows >> row.index & 1u) != 0) made->add(preset_row(row));
    }
    return known->second = shape_->add_class(std::move(made));
  }

  const Store& store_;
  Plan plan_;
  std::shared_ptr<PresetShape> shape_ = std::make_shared<PresetShape>();
  std::unordered_map<std::uint32_t, std::uint64_t> chosen_;  // by slot, what the patterns reach
  bool part_chosen_ = false;
  std::unordered_map<const Table*, std::uint64_t> eligible_;
  std::map<std::pair<const Table*, std::uint64_t>, std::uint32_t> classes_;
  std::vector<std::uint32_t> things_;  // by slot
};

Result<std::shared_ptr<const Preset>> PresetTaker::take(const Store& store, std::string name,
                                                        const PresetChoice& choice) {
  std::erase_if(plans_, [&](const Plan& plan) { return plan.structure != store.structure_version(); });
  auto known = std::find_if(plans_.begin(), plans_.end(), [&](const Plan& plan) { return plan.choice == choice; });
  if (known == plans_.end()) {
    Result<Plan> made = Planning(store, choice).make();
    if (!made) return Error{made.error()};
    if (plans_.size() >= kMostPlans) plans_.erase(plans_.begin());
    plans_.push_back(std::move(*made));
    known = plans_.end() - 1;
  }
  return copy(store, *known, std::move(name));
}

std::shared_ptr<const Preset> PresetTaker::copy(const Store& store, const Plan& plan, std::string name) {
  auto preset = std::make_shared<Preset>(Preset{std::move(name), plan.choice, plan.shape, {}});
  preset->values.reserve(plan.shape->width());
  for (const Piece& piece : plan.pieces) {
    const double* const from = (piece.live ? store.live() : store.kept()).data() + piece.from;
    preset->values.insert(preset->values.end(), from, from + piece.count);
  }
  return preset;
}

std::shared_ptr<const Preset> PresetTaker::take_script(const Store& store) {
  Result<Plan> plan = Planning(store, {}).make();  // without patterns nothing can be wrong
  auto preset = std::make_shared<Preset>(*copy(store, *plan, "script"));
  const Result<Place> scene = find_place(store, "/scene", false);
  if (!scene || scene->row != nullptr) return preset;
  const Table& table = store.table(scene->node);
  for (const PresetShape::Thing& thing : preset->shape->things()) {
    const PresetClass* const rows = preset->shape->rows(thing);
    if (rows == nullptr || thing.parent != 0 || preset->shape->name(thing) != "scene") continue;
    for (std::size_t i = 0; i < rows->rows.size(); i++) {
      const Row& row = table.at(rows->rows[i].name);
      std::copy_n(row.initial.begin(), row.width, preset->values.begin() + thing.at + rows->offsets[i]);
    }
  }
  return preset;
}

}  // namespace limber
