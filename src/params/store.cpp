// The store: nodes, blocks, the door, marks.
#include "params/store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "base/text.h"

namespace limber {

namespace {

const Table& group_table() {
  static const Table table("group", "", "", {});
  return table;
}

// grows by a quarter, not to the double: a thousand bodies' values are most of what they weigh
template <class T>
void make_room(std::vector<T>& v, std::size_t more) {
  if (v.size() + more > v.capacity()) v.reserve(v.size() + v.size() / 4 + more);
}

}  // namespace

Store::Store() {
  slots_.push_back({1, table_number(group_table()), 0, 0});
  nodes_.push_back({&group_table(), nullptr, "", {}, {}, 0, 0, 0, 0});
  root_ = {0, 1};
  refresh_view();
}

std::uint32_t Store::table_number(const Table& table) {
  const auto found = std::find(tables_.begin(), tables_.end(), &table);
  if (found != tables_.end()) return static_cast<std::uint32_t>(found - tables_.begin());
  tables_.push_back(&table);
  return static_cast<std::uint32_t>(tables_.size() - 1);
}

void Store::refresh_view() {
  view_ = {slots_.data(), kept_.data(), live_.data(), static_cast<std::uint32_t>(slots_.size())};
  for (StoreView* const copy : view_copies_) *copy = view_;
}

void Store::show_view(StoreView& copy) {
  copy = view_;
  view_copies_.push_back(&copy);
}

void Store::hide_view(StoreView& copy) { std::erase(view_copies_, &copy); }

void Store::order_children(NodeId parent, std::span<const NodeId> first) {
  if (!alive(parent)) return;
  std::vector<NodeId>& children = nodes_[parent.slot].children;
  std::vector<bool> named(slots_.size());
  for (const NodeId child : first) named[child.slot] = true;
  std::vector<NodeId> ordered(first.begin(), first.end());
  std::copy_if(children.begin(), children.end(), std::back_inserter(ordered),
               [&](NodeId child) { return !named[child.slot]; });
  LIMBER_CHECK(ordered.size() == children.size());
  children = std::move(ordered);
  note_change(parent);
}

std::uint32_t Store::take_block(std::vector<double>& block, std::vector<std::vector<std::uint32_t>>& spare,
                                std::uint32_t width) {
  if (width < spare.size() && !spare[width].empty()) {
    const std::uint32_t base = spare[width].back();
    spare[width].pop_back();
    return base;
  }
  const auto base = static_cast<std::uint32_t>(block.size());
  make_room(block, width);
  block.resize(block.size() + width, 0.0);
  return base;
}

NodeId Store::add(const Table& table, NodeId parent, std::string name, void* thing) {
  LIMBER_CHECK(alive(parent) && child(parent, name).null());
  std::uint32_t slot = 0;
  if (free_slots_.empty()) {
    slot = static_cast<std::uint32_t>(slots_.size());
    make_room(slots_, 1);
    make_room(nodes_, 1);
    slots_.emplace_back();
    nodes_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  NodeSlot& s = slots_[slot];
  s.generation++;  // even to odd: alive
  s.table = table_number(table);
  s.kept = take_block(kept_, spare_kept_, table.kept_width());
  s.live = take_block(live_, spare_live_, table.live_width());
  const NodeId id{slot, s.generation};
  nodes_[slot] = {&table, thing, std::move(name), parent, {}, 0, 0, structure_version_ + 1, 0};
  nodes_[parent.slot].children.push_back(id);
  child_of_.insert(slot);
  for (const Row& row : table.rows()) {
    if (row.stored()) std::copy_n(row.initial.data(), row.width, slot_values(id, row));
  }
  mark_all(id);
  kept_version_++;
  note_change(id);
  refresh_view();
  return id;
}

NodeId Store::add_group(NodeId parent, std::string name) {
  return add(group_table(), parent, std::move(name), nullptr);
}

bool Store::is_group(NodeId id) const { return alive(id) && nodes_[id.slot].table == &group_table(); }

const Store::Node& Store::nobody() {
  static const Node none{&group_table(), nullptr, "", {}, {}, 0, 0, 0, 0};
  return none;
}

NodeId Store::retable(NodeId id, const Table& table, void* thing) {
  if (!alive(id)) return {};
  Node& node = nodes_[id.slot];
  LIMBER_CHECK(node.children.empty());
  node.thing = thing;
  if (node.table == &table) return id;
  // what both tables have is carried over
  std::vector<double> carried;
  const Table& before = *node.table;
  for (const Row& row : table.rows()) {
    const std::size_t at = carried.size();
    carried.insert(carried.end(), row.initial.begin(), row.initial.begin() + row.width);
    const Row* const old = before.find(row.name);
    if (!row.stored() || old == nullptr || !old->stored() || old->type != row.type) continue;
    const double* const values = slot_values(id, *old);
    for (std::uint32_t i = 0; i < row.width; i++) carried[at + i] = std::clamp(values[i], row.low(i), row.high(i));
    if (row.type != RowType::choice) continue;
    // a choice is its label, wherever that now stands
    const auto label =
        std::find(row.choices.begin(), row.choices.end(), old->choices[static_cast<std::size_t>(values[0])]);
    carried[at] = label == row.choices.end() ? row.initial[0] : static_cast<double>(label - row.choices.begin());
  }
  give_back_blocks(id.slot);
  NodeSlot& slot = slots_[id.slot];
  slot.generation += 2;
  slot.table = table_number(table);
  slot.kept = take_block(kept_, spare_kept_, table.kept_width());
  slot.live = take_block(live_, spare_live_, table.live_width());
  node.table = &table;
  node.marks = 0;
  node.born = structure_version_ + 1;
  const NodeId renewed{id.slot, slot.generation};
  std::vector<NodeId>& siblings = nodes_[node.parent.slot].children;
  std::replace(siblings.begin(), siblings.end(), id, renewed);
  std::size_t at = 0;
  for (const Row& row : table.rows()) {
    if (row.stored()) std::copy_n(carried.data() + at, row.width, slot_values(renewed, row));
    at += row.width;
  }
  mark_all(renewed);
  kept_version_++;
  note_change(renewed);
  refresh_view();
  return renewed;
}

// the numbers of a node, whose room is used again
void Store::give_back_blocks(std::uint32_t at) {
  const NodeSlot& slot = slots_[at];
  const Table& table = *nodes_[at].table;
  const auto spare = [](std::vector<std::vector<std::uint32_t>>& list, std::uint32_t base, std::uint32_t width) {
    if (width == 0) return;
    if (list.size() <= width) list.resize(width + 1);
    list[width].push_back(base);
  };
  // a freed block is zero, so that snapshots and hashes do not tell of the dead
  std::fill_n(kept_.begin() + slot.kept, table.kept_width(), 0.0);
  std::fill_n(live_.begin() + slot.live, table.live_width(), 0.0);
  spare(spare_kept_, slot.kept, table.kept_width());
  spare(spare_live_, slot.live, table.live_width());
}

void Store::release(NodeId id) {
  for (const NodeId child : nodes_[id.slot].children) release(child);
  child_of_.erase(child_of_.find(id.slot));
  slots_[id.slot].generation++;  // odd to even: gone
  give_back(id.slot);
}

// what a slot holds, of a node that is gone
void Store::give_back(std::uint32_t at) {
  give_back_blocks(at);
  free_slots_.push_back(at);
  nodes_[at] = {};
}

// Something came, went or changed there, which all above it know of.
void Store::note_change(NodeId at) {
  structure_version_++;
  for (; !at.null(); at = nodes_[at.slot].parent) nodes_[at.slot].changed = structure_version_;
}

// its place among its siblings, which it leaves; what goes is mostly what came last
std::size_t Store::leave_siblings(NodeId id) {
  std::vector<NodeId>& siblings = nodes_[nodes_[id.slot].parent.slot].children;
  const auto at = std::find(siblings.rbegin(), siblings.rend(), id).base() - 1;
  const auto place = static_cast<std::size_t>(at - siblings.begin());
  siblings.erase(at);
  return place;
}

void Store::remove(NodeId id) {
  if (!alive(id) || id == root_) return;
  note_change(id);
  leave_siblings(id);
  release(id);
  kept_version_++;
}

NodeId Store::child(NodeId parent, std::string_view name) const {
  const auto found = child_of_.find(ChildKey{parent.slot, name});
  return found == child_of_.end() ? NodeId{} : NodeId{*found, slots_[*found].generation};
}

std::string Store::path(NodeId id) const {
  if (id == root_ || !alive(id)) return id == root_ ? "/" : "";
  std::string path;
  for (NodeId at = id; at != root_; at = nodes_[at.slot].parent) path = "/" + escape_name(nodes_[at.slot].name) + path;
  return path;
}

Result<SetOutcome> Store::set(NodeId id, std::string_view row, std::span<const double> values) {
  if (!alive(id)) return Error{"this thing no longer exists"};
  return set(id, table(id).at(row), values);
}

Result<SetOutcome> Store::take(NodeId id, const Row& row, std::span<const double> values, double* taken) const {
  const auto where = [&] { return fmt::format("{}/{}", path(id), row.name); };
  if (!alive(id)) return Error{"this thing no longer exists"};
  if (!row.writable() || (row.view() && row.write == nullptr)) {
    return Error{fmt::format("{} can be {}, not set", where(), row.kind == RowKind::action ? "done" : "read")};
  }
  if (values.size() != row.width) {
    return Error{
        fmt::format("{} takes {} number{}, not {}", where(), row.width, row.width == 1 ? "" : "s", values.size())};
  }
  SetOutcome outcome;
  for (std::size_t i = 0; i < row.width; i++) {
    double v = values[i];
    if (!std::isfinite(v)) return Error{fmt::format("{} takes numbers; {} is none", where(), v)};
    if (row.type == RowType::boolean || row.type == RowType::flags3) {
      v = v >= 0.5 ? 1 : 0;
    } else if (row.type == RowType::integer || row.type == RowType::choice) {
      v = std::round(v);
    }
    taken[i] = std::clamp(v, row.low(i), row.high(i));
    const bool flag = row.type == RowType::boolean || row.type == RowType::flags3;
    if (!flag && taken[i] != v) outcome.clamped = true;
  }
  if (row.type == RowType::choice && outcome.clamped) {
    return Error{
        fmt::format("{} has the choices {}; {} is none of them", where(), fmt::join(row.choices, ", "), values[0])};
  }
  if (row.type == RowType::quat) {
    const double square = taken[0] * taken[0] + taken[1] * taken[1] + taken[2] * taken[2] + taken[3] * taken[3];
    if (square < 1e-18) return Error{fmt::format("{} takes a rotation; 0 0 0 0 is none", where())};
    // what is of length 1 but for rounding stays to the bit: a value that was read can be set again
    if (std::abs(square - 1) > 1e-14) {
      for (std::size_t i = 0; i < 4; i++) taken[i] /= std::sqrt(square);
    }
  }
  if (row.refuse != nullptr) {
    if (const Result<void> may = row.refuse(nodes_[id.slot].thing, taken); !may) {
      return Error{fmt::format("{}: {}", where(), may.error())};
    }
  }
  return outcome;
}

Result<SetOutcome> Store::set(NodeId id, const Row& row, std::span<const double> values) {
  std::array<double, 4> taken{};
  Result<SetOutcome> outcome = take(id, row, values, taken.data());
  if (!outcome) return outcome;
  void* const the_thing = nodes_[id.slot].thing;
  if (saying_) say(id, row);
  if (row.view()) {
    row.write(the_thing, taken.data());
    return outcome;
  }
  write(id, row, taken.data());
  mark(id, row);
  if (row.written != nullptr) row.written(the_thing, row);
  return outcome;
}

void Store::get(NodeId id, const Row& row, double* out) const {
  if (!alive(id)) return (void)std::fill_n(out, row.width, 0.0);
  if (row.view()) return row.read(nodes_[id.slot].thing, out);
  if (row.stored()) std::copy_n(values(id, row), row.width, out);
}

void Store::mark(NodeId id, const Row& row) {
  if (row.effect == nullptr || !alive(id)) return;
  Node& node = nodes_[id.slot];
  if (node.marks == 0) marked_.push_back(id);
  node.marks |= std::uint64_t{1} << row.index;
  apart_ = apart_ && row.apart;
}

void Store::mark_all(NodeId id) {
  for (const Row& row : nodes_[id.slot].table->rows()) mark(id, row);
}

void Store::apply_marks(Team* team) {
  // an effect may mark again (a view of a view): then once more, but not for ever
  for (int round = 0; round < 4 && !marked_.empty(); round++) {
    applying_.clear();
    applying_.swap(marked_);
    Team* const helpers = std::exchange(apart_, true) ? team : nullptr;
    share_out_places(helpers, static_cast<int>(applying_.size()), [this](int, int first, int end) {
      for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); i++) {
        fetch_ahead(i, applying_.size(), [this](std::size_t place) { return applying_[place]; });
        run_marks(applying_[i]);
      }
    });
  }
}

// the node stays in the list, where it finds nothing left to do: looking for it would cost more
void Store::apply_marks(NodeId id) {
  apart_ = false;
  run_marks(id);
}

void Store::run_marks(NodeId id) {
  if (alive(id)) run_effects(id, std::exchange(nodes_[id.slot].marks, 0));
}

void Store::run_effects(NodeId id, std::uint64_t rows) {
  const Table& table = *nodes_[id.slot].table;
  std::array<void (*)(void*), 64> done;
  auto end = done.begin();
  for (; rows != 0; rows &= rows - 1) {
    const Row& row = table.row(static_cast<std::uint32_t>(std::countr_zero(rows)));
    if (row.effect == nullptr || std::find(done.begin(), end, row.effect) != end) continue;
    *end++ = row.effect;
    row.effect(nodes_[id.slot].thing);
  }
}

}  // namespace limber
