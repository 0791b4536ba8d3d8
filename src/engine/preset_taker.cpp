// A walk over the store for a plan; along the plan for a preset.
#include "engine/preset_taker.h"

#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "params/catalog.h"
#include "sim/part.h"

namespace limber {

namespace {

constexpr std::size_t kMostPlans = 8;
// What comes takes far more of its tick than a look at it: where this part of all came or went, all is looked at.
constexpr std::uint64_t kMuch = 8;
constexpr std::size_t kThingsAhead = 3;  // things that are fetched while others are looked at: they may lie far off

// many megabytes that are touched for the first time would be a fault every 4 KB; without large pages it goes as well
void ask_for_large_pages(const std::vector<double>& room) {
  constexpr std::uintptr_t kPage = 4096;
  constexpr std::size_t kLarge = std::size_t{4} << 20u;
  const std::size_t bytes = room.capacity() * sizeof(double);
  if (bytes < kLarge) return;
  auto* const first = const_cast<char*>(reinterpret_cast<const char*>(room.data()));
  const std::size_t skipped = (kPage - reinterpret_cast<std::uintptr_t>(first) % kPage) % kPage;
  (void)madvise(first + skipped, bytes - kPage, MADV_HUGEPAGE);
}

PresetRow preset_row(const Row& row) {
  const RowType type = row.type == RowType::integer ? RowType::number : row.type;
  return {row.name, type, row.width, row.choices};
}

}  // namespace

class PresetTaker::Planning {
 public:
  /// `before`: the plan of the same choice when less had come or gone, or null; it stays until this is finished.
  Planning(const Store& store, const PresetChoice& choice, const Plan* before) : store_(store), before_(before) {
    plan_.choice = choice;
    plan_.structure = store.structure_version();
  }

  /// What the patterns reach. First, and once.
  Result<void> begin() {
    Result<void> chosen = choose();
    things_.assign(store_.view()->slot_count, 0);
    if (leads_.empty()) {
      shape_->expect(things_.size());
      plan_.slots.reserve(things_.size());
    }
    plan_.slots.push_back(store_.root().slot);
    way_.push_back(store_.root());
    if (before_ != nullptr) begin_with(*before_);
    return chosen;
  }
  /// Looks at so many things; true: at all of them.
  bool go(std::size_t count) {
    while (!way_.empty()) {
      if (count-- == 0) return false;
      const NodeId id = way_.back();
      way_.pop_back();
      if (way_.size() >= kThingsAhead) store_.fetch_thing(way_[way_.size() - kThingsAhead]);
      if (before_ != nullptr && id != store_.root() && store_.changed(id) <= before_->structure) {
        keep(id);
        continue;
      }
      add(id);
      const std::span<const NodeId> children = store_.children(id);
      for (auto child = children.rbegin(); child != children.rend(); ++child) {
        if (!leads_.empty() && !leads_[child->slot]) continue;
        store_.fetch_node(*child);
        way_.push_back(*child);
      }
    }
    return true;
  }
  Result<Plan> finish() {
    const PresetChoice& choice = plan_.choice;
    if (!choice.rows.empty() && shape_->row_count() == 0)
      return Error{fmt::format("'{}' reaches no property", printable(fmt::format("{}", fmt::join(choice.rows, " "))))};
    plan_.shape = shape_;
    return std::move(plan_);
  }
  static Result<Plan> make(const Store& store, const PresetChoice& choice, const Plan* before) {
    Planning planning(store, choice, before);
    if (const Result<void> begun = planning.begin(); !begun) return Error{begun.error()};
    (void)planning.go(SIZE_MAX);
    return planning.finish();
  }

 private:
  // rows by slot, of those that the patterns reach
  Result<void> choose() {
    const PresetChoice& choice = plan_.choice;
    if (choice.rows.empty()) return {};
    chosen_.assign(store_.view()->slot_count, 0);
    leads_.assign(chosen_.size(), false);
    for (const std::string& pattern : choice.rows) {
      PatternBudget budget;
      const Result<std::vector<PlaceRows>> things = match_things(store_, pattern, budget);
      if (!things) return Error{things.error()};
      for (const auto& [node, rows] : *things) {
        // a thing stands for all that it has, and for what is in it
        if (rows == 0)
          store_.walk(node, [&](NodeId id) { choose(id, ~std::uint64_t{0}); });
        else
          choose(node, rows);
      }
    }
    // where parts are is asked for by its own word: of the parts that the patterns reach, else of all
    if (!part_chosen_ && (choice.poses || choice.velocities)) leads_.clear();
    return {};
  }

  void choose(NodeId id, std::uint64_t rows) {
    part_chosen_ = part_chosen_ || &store_.table(id) == &Part::table();
    chosen_[id.slot] |= rows;
    for (NodeId at = id; !at.null() && !leads_[at.slot]; at = store_.parent(at)) leads_[at.slot] = true;
  }

  // what a class may give: properties, and of parts the states that are asked for
  struct Kind {
    std::uint64_t rows = 0;
    std::uint64_t properties = 0;
    std::vector<const Row*> picky;  // of these some things take none: the mass of a part that never moves
  };
  const Kind& kind_of(const Table& table) {
    if (last_kind_.first == &table) return *last_kind_.second;
    const auto [known, fresh] = kinds_.try_emplace(&table);
    Kind& kind = known->second;
    last_kind_ = {&table, &kind};
    if (!fresh) return kind;
    const PresetChoice& choice = plan_.choice;
    for (const Row& row : table.rows()) {
      const bool pose = row.name == "position" || row.name == "rotation";
      const bool motion = row.name == "linear_velocity" || row.name == "angular_velocity";
      const bool wanted = row.kind == RowKind::property || (&table == &Part::table() && row.kind == RowKind::state &&
                                                            ((pose && choice.poses) || (motion && choice.velocities)));
      if (!wanted || !row.stored()) continue;
      const std::uint64_t bit = std::uint64_t{1} << row.index;
      kind.rows |= bit;
      if (row.kind == RowKind::property) kind.properties |= bit;
      if (row.refuse != nullptr) kind.picky.push_back(&row);
    }
    return kind;
  }

  void add(NodeId id) {
    const Table& table = store_.table(id);
    const Kind& kind = kind_of(table);
    std::uint64_t rows = kind.rows;
    if (!chosen_.empty()) {
      const std::uint64_t chosen = chosen_[id.slot];
      const bool with_states = chosen != 0 || !part_chosen_;
      rows = (rows & chosen) | (with_states ? rows & ~kind.properties : 0);
    }
    for (const Row* row : kind.picky) {
      const std::uint64_t bit = std::uint64_t{1} << row->index;
      if ((rows & bit) != 0 && !row->refuse(store_.thing(id), store_.values(id, *row))) rows &= ~bit;
    }
    if (rows == 0) return;
    const Cut& cut = cut_of(table, rows);
    const std::uint32_t at = shape_->width();
    shape_->give(thing(id), cut.rows);
    const NodeSlot& slot = store_.view()->slots[id.slot];
    for (const Piece& piece : cut.pieces)
      append({(piece.live ? slot.live : slot.kept) + piece.from, piece.count, piece.live, at + piece.at}, plan_.pieces);
  }

  void begin_with(const Plan& before) {
    before_things_.assign(things_.size(), 0);
    for (std::uint32_t i = 0; i < before.slots.size(); i++) before_things_[before.slots[i]] = i;
    for (const auto& rows : before.shape->classes()) shape_->add_class(rows);
    plan_.cuts = before.cuts;
  }

  // a thing and all below it, which stand as they stood
  void keep(NodeId id) {
    const std::uint32_t first = before_things_[id.slot];
    if (first == 0) return;  // nothing there has rows
    const std::uint32_t begin = shape_->width();
    const std::uint32_t made = shape_->add_all(*before_->shape, first, thing(store_.parent(id)));
    const auto from = before_->slots.begin() + first;
    plan_.slots.insert(plan_.slots.end(), from, from + static_cast<std::ptrdiff_t>(shape_->things().size() - made));
    keep_pieces(before_->shape->first_number(first), begin, shape_->width() - begin);
  }

  // so many numbers from a place in the preset before
  void keep_pieces(std::uint32_t from, std::uint32_t to, std::uint32_t count) {
    const std::vector<Piece>& pieces = before_->pieces;
    auto at = std::upper_bound(pieces.begin(), pieces.end(), from,
                               [](std::uint32_t number, const Piece& piece) { return number < piece.at; });
    if (count > 0) --at;
    for (std::uint32_t done = 0; done < count; ++at) {
      const std::uint32_t skipped = from + done - at->at;
      const std::uint32_t taken = std::min(at->count - skipped, count - done);
      append({at->from + skipped, taken, at->live, to + done}, plan_.pieces);
      done += taken;
    }
  }

  static void append(const Piece& piece, std::vector<Piece>& pieces) {
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
      plan_.slots.push_back(id.slot);
    }
    return known;
  }

  const Cut& cut_of(const Table& table, std::uint64_t rows) {
    const std::pair<const Table*, std::uint64_t> key{&table, rows};
    if (last_cut_.second != nullptr && last_cut_.first == key) return *last_cut_.second;
    const auto [known, fresh] = plan_.cuts.try_emplace(key);
    Cut& cut = known->second;
    last_cut_ = {key, &cut};
    if (!fresh) return cut;
    auto made = std::make_shared<PresetClass>();
    for (const Row& row : table.rows()) {
      if ((rows >> row.index & 1u) == 0) continue;
      append({row.offset, row.width, row.live, made->width}, cut.pieces);
      made->add(preset_row(row));
    }
    cut.rows = shape_->add_class(std::move(made));
    return cut;
  }

  const Store& store_;
  const Plan* before_;
  std::vector<std::uint32_t> before_things_;  // by slot
  Plan plan_;
  std::shared_ptr<PresetShape> shape_ = std::make_shared<PresetShape>();
  std::vector<std::uint64_t> chosen_;  // by slot, what the patterns reach; empty: there are none
  std::vector<bool> leads_;            // by slot, whether something at or below it may be chosen; empty: all do
  bool part_chosen_ = false;
  std::unordered_map<const Table*, Kind> kinds_;
  // neighbours are alike
  std::pair<const Table*, const Kind*> last_kind_{};
  std::pair<std::pair<const Table*, std::uint64_t>, const Cut*> last_cut_{};
  std::vector<std::uint32_t> things_;  // by slot
  std::vector<NodeId> way_;            // to be looked at, the next one last
};

PresetTaker::PresetTaker() = default;
PresetTaker::~PresetTaker() = default;

void PresetTaker::forget_store() {
  plans_.clear();
  ahead_.reset();
  before_.reset();
  quiet_ = 0;
}

// plans hold as long as nothing comes or goes
void PresetTaker::follow(const Store& store) {
  if (structure_ == store.structure_version()) return;
  structure_ = store.structure_version();
  ahead_.reset();
  quiet_ = 0;
  for (Plan& plan : plans_) {
    if (plan.choice == PresetChoice{}) before_ = std::move(plan);
  }
  plans_.clear();
}

const PresetTaker::Plan* PresetTaker::known(const PresetChoice& choice) const {
  const auto at = std::find_if(plans_.begin(), plans_.end(), [&](const Plan& plan) { return plan.choice == choice; });
  return at == plans_.end() ? nullptr : &*at;
}

const PresetTaker::Plan* PresetTaker::before(const PresetChoice& choice) const {
  return before_ && before_->choice == choice ? &*before_ : nullptr;
}

const PresetTaker::Plan& PresetTaker::keep(Plan plan) {
  if (plans_.size() >= kMostPlans) plans_.erase(plans_.begin());
  return plans_.emplace_back(std::move(plan));
}

// What is touched for the first time is a fault in every page, which take longer than the copy: beside the show.
void PresetTaker::make_room(const Store& store) {
  const std::size_t numbers = store.kept().size();
  if (numbers < kRoomWorth) return;
  if (making_room_.valid()) {
    if (making_room_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    room_ = making_room_.get();
  }
  if (room_.size() >= numbers) return;
  try {
    making_room_ = std::async(std::launch::async, [count = numbers + numbers / 8] {
      pthread_setname_np(pthread_self(), "limber-room");
      std::vector<double> room;
      room.reserve(count);
      ask_for_large_pages(room);
      room.resize(count);
      return room;
    });
  } catch (const std::system_error&) {
    // no thread is to be had: the copy will take longer
  }
}

void PresetTaker::prepare(const Store& store) {
  const std::uint64_t changes = store.structure_version() - structure_;
  follow(store);
  make_room(store);
  if (changes * kMuch >= store.view()->slot_count) return make_ready(store);
  if (quiet_ <= kQuiet) quiet_++;
  if (quiet_ <= kQuiet || known({}) != nullptr) return;
  if (ahead_ == nullptr) {
    ahead_ = std::make_unique<Planning>(store, PresetChoice{}, before({}));
    (void)ahead_->begin();  // there are no patterns
  }
  if (!ahead_->go(kSlice)) return;
  keep(std::move(*ahead_->finish()));
  ahead_.reset();
}

// it stays until the next is asked for
Result<const PresetTaker::Plan*> PresetTaker::plan_for(const Store& store, const PresetChoice& choice) {
  follow(store);
  if (const Plan* plan = known(choice)) return plan;
  const bool begun = ahead_ != nullptr && choice == PresetChoice{};
  if (begun) (void)ahead_->go(SIZE_MAX);
  Result<Plan> made = begun ? ahead_->finish() : Planning::make(store, choice, before(choice));
  if (begun) ahead_.reset();
  if (!made) return Error{made.error()};
  return &keep(std::move(*made));
}

Result<std::shared_ptr<const Preset>> PresetTaker::take(const Store& store, std::string name,
                                                        const PresetChoice& choice) {
  const Result<const Plan*> plan = plan_for(store, choice);
  if (!plan) return Error{plan.error()};
  // what is much smaller is not worth all of the room
  std::vector<double> room;
  if ((*plan)->shape->width() > room_.size() / 2) room.swap(room_);
  return copy(store, **plan, std::move(name), std::move(room));
}

std::shared_ptr<const Preset> PresetTaker::copy(const Store& store, const Plan& plan, std::string name,
                                                std::vector<double> room) {
  room.clear();
  auto preset = std::make_shared<Preset>(Preset{std::move(name), plan.choice, plan.shape, std::move(room)});
  preset->values.reserve(plan.shape->width());
  ask_for_large_pages(preset->values);
  for (const Piece& piece : plan.pieces) {
    const double* const from = (piece.live ? store.live() : store.kept()).data() + piece.from;
    preset->values.insert(preset->values.end(), from, from + piece.count);
  }
  return preset;
}

std::shared_ptr<const Preset> PresetTaker::take_script(const Store& store) {
  Result<Plan> plan = Planning::make(store, {}, nullptr);  // without patterns nothing can be wrong
  auto preset = std::make_shared<Preset>(*copy(store, *plan, "script", {}));
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
