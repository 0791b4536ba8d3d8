// A walk over the store, and one over what it found.
#include "engine/preset_plan.h"

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "params/catalog.h"
#include "params/path_walk.h"
#include "sim/part.h"

namespace limber {

namespace {

constexpr int kPatternWork = 8 * PatternBudget::kMessage;  // some patterns over all of a large world
constexpr std::size_t kThingsAhead = 3;  // things that are fetched while others are looked at: they may lie far off

PresetRow preset_row(const Row& row) {
  const RowType type = row.type == RowType::integer ? RowType::number : row.type;
  return {row.name, type, row.width, row.choices};
}

// the rows of parts that tell where they are and how they move, as far as they are asked for
std::uint64_t part_states(const PresetChoice& choice) {
  std::uint64_t rows = 0;
  const auto add = [&](const char* name) { rows |= std::uint64_t{1} << Part::table().at(name).index; };
  if (choice.poses) {
    add("position");
    add("rotation");
  }
  if (choice.velocities) {
    add("linear_velocity");
    add("angular_velocity");
  }
  return rows;
}

}  // namespace

void PresetPlan::append(const Piece& piece, std::vector<Piece>& pieces) {
  const bool joins =
      !pieces.empty() && pieces.back().live == piece.live && pieces.back().from + pieces.back().count == piece.from;
  if (joins) {
    pieces.back().count += piece.count;
  } else {
    pieces.push_back(piece);
  }
}

const PresetPlan::Cut& PresetPlan::cut_of(PresetShape& shape, const Table& table, std::uint64_t rows) {
  if (last_cut_ != nullptr && last_cut_->table == &table && last_cut_->rows == rows) return *last_cut_;
  const auto [known, fresh] = cuts_.try_emplace({&table, rows});
  Cut& cut = known->second;
  last_cut_ = &cut;
  if (!fresh) return cut;
  cut.table = &table;
  cut.rows = rows;
  auto made = std::make_shared<PresetClass>();
  for (const Row& row : table.rows()) {
    if ((rows >> row.index & 1u) == 0) continue;
    append({row.offset, row.width, row.live, made->width}, cut.pieces);
    made->add(preset_row(row));
  }
  cut.number = shape.add_class(std::move(made));
  return cut;
}

// a thing's numbers, which stand in the preset from there on
void PresetPlan::take(const Cut& cut, const NodeSlot& slot, std::uint32_t at) {
  for (const Piece& piece : cut.pieces)
    append({(piece.live ? slot.live : slot.kept) + piece.from, piece.count, piece.live, at + piece.at});
}

PresetPlanning::PresetPlanning(const Store& store, const PresetPlan* before) : store_(store), before_(before) {
  plan_.structure_ = store.structure_version();
  things_.assign(store_.view()->slot_count, 0);
  shape_->expect(things_.size());
  plan_.nodes_.reserve(things_.size());
  plan_.nodes_.push_back(store_.root());
  way_.push_back(store_.root());
  if (before_ == nullptr) return;
  before_things_.assign(things_.size(), 0);
  for (std::uint32_t i = 0; i < before_->nodes_.size(); i++) before_things_[before_->nodes_[i].slot] = i;
  for (const auto& rows : before_->shape->classes()) shape_->add_class(rows);
  plan_.cuts_ = before_->cuts_;
  plan_.pieces.reserve(before_->pieces.size() + before_->pieces.size() / 8);
}

bool PresetPlanning::go(std::size_t count) {
  while (!way_.empty()) {
    if (count-- == 0) return false;
    const NodeId id = way_.back();
    way_.pop_back();
    if (way_.size() >= kThingsAhead) store_.fetch_thing(way_[way_.size() - kThingsAhead]);
    if (before_ != nullptr && id != store_.root() && store_.changed(id) <= before_->structure_) {
      keep(id);
      continue;
    }
    add(id);
    const std::span<const NodeId> children = store_.children(id);
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      store_.fetch_node(*child);
      way_.push_back(*child);
    }
  }
  return true;
}

PresetPlan PresetPlanning::finish() {
  plan_.shape = shape_;
  plan_.last_cut_ = nullptr;  // it stays where it is, but a plan may be copied
  return std::move(plan_);
}

PresetPlan PresetPlanning::make(const Store& store, const PresetPlan* before) {
  PresetPlanning planning(store, before);
  (void)planning.go(SIZE_MAX);
  return planning.finish();
}

const PresetPlanning::Kind& PresetPlanning::kind_of(const Table& table) {
  if (last_kind_.first == &table) return *last_kind_.second;
  const auto [known, fresh] = kinds_.try_emplace(&table);
  Kind& kind = known->second;
  last_kind_ = {&table, &kind};
  if (!fresh) return kind;
  for (const Row& row : table.rows()) {
    if (row.kind != RowKind::property || !row.stored()) continue;
    kind.rows |= std::uint64_t{1} << row.index;
    if (row.refuse != nullptr) kind.picky.push_back(&row);
  }
  return kind;
}

void PresetPlanning::add(NodeId id) {
  const Table& table = store_.table(id);
  const Kind& kind = kind_of(table);
  std::uint64_t rows = kind.rows;
  for (const Row* row : kind.picky) {
    if (!row->refuse(store_.thing(id), store_.values(id, *row))) rows &= ~(std::uint64_t{1} << row->index);
  }
  if (rows == 0) return;
  const PresetPlan::Cut& cut = plan_.cut_of(*shape_, table, rows);
  const std::uint32_t at = shape_->width();
  shape_->give(thing(id), cut.number);
  plan_.take(cut, store_.view()->slots[id.slot], at);
}

// a thing and all below it, which stand as they stood
void PresetPlanning::keep(NodeId id) {
  const std::uint32_t first = before_things_[id.slot];
  if (first == 0) return;  // nothing there has rows
  const std::uint32_t begin = shape_->width();
  const std::uint32_t made = shape_->add_all(*before_->shape, first, thing(store_.parent(id)));
  const auto from = before_->nodes_.begin() + first;
  plan_.nodes_.insert(plan_.nodes_.end(), from, from + static_cast<std::ptrdiff_t>(shape_->things().size() - made));
  keep_pieces(before_->shape->first_number(first), begin, shape_->width() - begin);
}

// so many numbers from a place in the preset before
void PresetPlanning::keep_pieces(std::uint32_t from, std::uint32_t to, std::uint32_t count) {
  const std::vector<PresetPlan::Piece>& pieces = before_->pieces;
  auto at = std::upper_bound(pieces.begin(), pieces.end(), from,
                             [](std::uint32_t number, const PresetPlan::Piece& piece) { return number < piece.at; });
  if (count > 0) --at;
  for (std::uint32_t done = 0; done < count; ++at) {
    const std::uint32_t skipped = from + done - at->at;
    const std::uint32_t taken = std::min(at->count - skipped, count - done);
    const PresetPlan::Piece piece{at->from + skipped, taken, at->live, to + done};
    // only the first can go on from what stands before it
    if (done == 0) {
      plan_.append(piece);
    } else {
      plan_.pieces.push_back(piece);
    }
    done += taken;
  }
}

std::uint32_t PresetPlanning::thing(NodeId id) {
  if (id == store_.root()) return 0;
  std::uint32_t& known = things_[id.slot];
  if (known == 0) {
    const std::uint32_t parent = thing(store_.parent(id));
    known = shape_->add(parent, store_.name(id));
    plan_.nodes_.push_back(id);
  }
  return known;
}

// What a plan tells of, as patterns look at it: close together, and without what has no property anyway. Things are
// known by their number.
class PresetPlan::Things {
 public:
  struct Place {
    std::uint32_t node = 0;
    const Row* row = nullptr;
  };
  struct PlaceRows {
    std::uint32_t node = 0;
    std::uint64_t rows = 0;
  };

  Things(const Store& store, const PresetPlan& plan) : store_(store), plan_(plan), end_(size()) {
    // those below a thing stand behind it
    for (auto i = static_cast<std::uint32_t>(size()); i-- > 0;) {
      end_[i] = std::max(end_[i], i + 1);
      std::uint32_t& parents = end_[all()[i].parent];
      parents = std::max(parents, end_[i]);
    }
    of_class_.resize(plan.shape->classes().size());
    for (const auto& [key, cut] : plan.cuts_) of_class_[cut.number] = &cut;
  }

  std::size_t size() const { return all().size(); }
  /// Behind the last thing below this one.
  std::uint32_t end(std::uint32_t thing) const { return end_[thing]; }
  /// What the thing gives, or null.
  const Cut* cut(std::uint32_t thing) const {
    return all()[thing].rows == PresetShape::kNoRows ? nullptr : of_class_[all()[thing].rows];
  }
  /// The thing of a node, or size().
  std::uint32_t find(NodeId node) {
    if (of_slot_.empty()) {
      of_slot_.assign(store_.view()->slot_count, static_cast<std::uint32_t>(size()));
      for (std::uint32_t i = 0; i < size(); i++) of_slot_[plan_.nodes_[i].slot] = i;
    }
    return of_slot_[node.slot];
  }

  // for PathWalk
  std::uint32_t root() const { return 0; }
  std::string_view name(std::uint32_t thing) const { return plan_.shape->name(all()[thing]); }
  const Table& table(std::uint32_t thing) const {
    const Cut* const its = cut(thing);
    return its != nullptr ? *its->table : store_.table(plan_.nodes_[thing]);
  }
  std::string path(std::uint32_t thing) const { return plan_.shape->path(thing); }
  std::uint32_t key(std::uint32_t thing) const { return thing; }
  std::size_t keys() const { return size(); }
  std::optional<std::uint32_t> exact_child(std::uint32_t parent, std::string_view wanted) const {
    std::optional<std::uint32_t> found;
    each_child(parent, [&](std::uint32_t child) {
      if (name(child) == wanted) found = child;
      return !found;
    });
    return found;
  }
  template <class F>
  void each_child(std::uint32_t parent, F&& f) const {
    for (std::uint32_t child = parent + 1; child < end_[parent]; child = end_[child]) {
      if (!f(child)) return;
    }
  }

 private:
  const std::vector<PresetShape::Thing>& all() const { return plan_.shape->things(); }

  const Store& store_;
  const PresetPlan& plan_;
  std::vector<std::uint32_t> end_;
  std::vector<const Cut*> of_class_;
  std::vector<std::uint32_t> of_slot_;  // once a node was asked for
};

class PresetPlan::Choosing {
 public:
  Choosing(const Store& store, const PresetPlan& every, const PresetChoice& choice)
      : store_(store),
        every_(every),
        things_(store, every),
        states_(part_states(choice)),
        chosen_(things_.size(), choice.rows.empty() ? ~std::uint64_t{0} : 0) {
    plan_.choice = choice;
  }

  Result<PresetPlan> make() {
    for (const std::string& pattern : plan_.choice.rows) {
      if (const Result<void> chosen = choose(pattern); !chosen) return Error{chosen.error()};
    }
    const auto count = static_cast<std::size_t>(std::ranges::count_if(chosen_, [](auto rows) { return rows != 0; }));
    shape_->expect(count + count / 4);  // with those that lead to them
    plan_.nodes_.reserve(count + count / 4);
    plan_.pieces.reserve(2 * count);
    plan_.nodes_.push_back(store_.root());
    numbers_.assign(things_.size(), 0);
    for (std::uint32_t i = 0; i < things_.size(); i++) add(i);
    const std::vector<std::string>& patterns = plan_.choice.rows;
    if (!patterns.empty() && shape_->row_count() == 0)
      return Error{fmt::format("'{}' reaches no property", printable(fmt::format("{}", fmt::join(patterns, " "))))};
    plan_.shape = shape_;
    plan_.last_cut_ = nullptr;
    return std::move(plan_);
  }

 private:
  Result<void> choose(const std::string& pattern) {
    if (is_address_pattern(pattern)) {
      const auto found = PathWalk(things_, budget_).match_things(pattern, SIZE_MAX);
      if (!found) return Error{found.error()};
      for (const Things::PlaceRows& place : *found) choose(place.node, place.rows);
      return {};
    }
    const Result<Place> place = find_place(store_, pattern);
    if (!place) return Error{place.error()};
    const std::uint32_t thing = things_.find(place->node);
    if (thing == things_.size()) return {};
    if (place->row != nullptr) {
      choose(thing, std::uint64_t{1} << place->row->index);
    } else {
      // a thing stands for all that it has, and for what is in it
      for (std::uint32_t i = thing; i < things_.end(thing); i++) choose(i, ~std::uint64_t{0});
    }
    return {};
  }

  void choose(std::uint32_t thing, std::uint64_t rows) {
    chosen_[thing] |= rows;
    part_chosen_ = part_chosen_ || &things_.table(thing) == &Part::table();
  }

  void add(std::uint32_t thing) {
    const Cut* const has = things_.cut(thing);
    if (has == nullptr) return;
    std::uint64_t rows = has->rows & chosen_[thing];
    // where parts are is asked for by its own word: of the parts that the patterns reach, else of all
    if (states_ != 0 && has->table == &Part::table() && (chosen_[thing] != 0 || !part_chosen_)) rows |= states_;
    if (rows == 0) return;
    const Cut& cut = plan_.cut_of(*shape_, *has->table, rows);
    const std::uint32_t at = shape_->width();
    shape_->give(number(thing), cut.number);
    plan_.take(cut, store_.view()->slots[every_.nodes_[thing].slot], at);
  }

  std::uint32_t number(std::uint32_t thing) {
    if (thing == 0) return 0;
    if (numbers_[thing] == 0) {
      const PresetShape::Thing& its = every_.shape->things()[thing];
      const std::uint32_t parent = number(its.parent);
      numbers_[thing] = shape_->add(parent, every_.shape->name(its));
      plan_.nodes_.push_back(every_.nodes_[thing]);
    }
    return numbers_[thing];
  }

  const Store& store_;
  const PresetPlan& every_;
  Things things_;
  std::uint64_t states_;
  PatternBudget budget_{kPatternWork};  // of all patterns together: a message may have thousands
  std::vector<std::uint64_t> chosen_;   // rows by thing
  bool part_chosen_ = false;
  PresetPlan plan_;
  std::shared_ptr<PresetShape> shape_ = std::make_shared<PresetShape>();
  std::vector<std::uint32_t> numbers_;  // of things in the new shape
};

Result<PresetPlan> PresetPlan::of_choice(const Store& store, const PresetPlan& every, const PresetChoice& choice) {
  return Choosing(store, every, choice).make();
}

}  // namespace limber
