// Walks by path and by pattern over what is shaped like the store: the store itself, and copies of its structure.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/result.h"
#include "base/text.h"
#include "params/pattern_budget.h"
#include "params/table.h"

namespace limber {

/// Whether the address may reach several places: it is matched, not looked up.
inline bool is_address_pattern(std::string_view address) {
  return address.find_first_of("?*[{") != std::string_view::npos || address.find("//") != std::string_view::npos;
}

/// A Shape has a `Place` {node, row}, a `PlaceRows` {node, rows as bits} and of its nodes: root(), name, table, path,
/// key (a number of its own, below keys()), exact_child (the child of exactly that name, or nothing), and each_child,
/// whose function says whether to go on.
template <class Shape>
class PathWalk {
 public:
  using Place = typename Shape::Place;
  using PlaceRows = typename Shape::PlaceRows;
  using Id = decltype(Place::node);

  PathWalk(const Shape& shape, PatternBudget& budget) : shape_(shape), budget_(budget) {}

  /// `hint`: near names in the error, which may be much work.
  static Result<Place> find(const Shape& shape, std::string_view path, bool hint = true) {
    if (path.empty() || path.front() != '/')
      return Error{fmt::format("'{}' is no address: it must begin with /", printable(path))};
    if (path.back() == '/') path.remove_suffix(1);
    Id at = shape.root();
    const std::vector<std::string_view> pieces =
        path.empty() ? std::vector<std::string_view>{} : split(path.substr(1), '/');
    for (std::size_t i = 0; i < pieces.size(); i++) {
      const std::string name = unescape_name(pieces[i]);
      if (const auto child = child_named(shape, at, name)) {
        at = *child;
        continue;
      }
      const Row* row = shape.table(at).find(name);
      if (row != nullptr && i + 1 == pieces.size()) return Place{at, row};
      return Error{fmt::format("there is no '{}' in {}{}", printable(name), shape.path(at),
                               hint ? near_names(shape, at, name) : "")};
    }
    return Place{at, nullptr};
  }

  Result<std::vector<Place>> match(std::string_view pattern, std::size_t limit) {
    const Result<std::vector<PlaceRows>> things = match_things(pattern, limit);
    if (!things) return Error{things.error()};
    std::vector<Place> places;
    places.reserve(std::min(count_, limit));
    for (const PlaceRows& thing : *things) {
      if (thing.rows == 0) places.push_back({thing.node, nullptr});
      const Table& table = shape_.table(thing.node);
      for (std::uint64_t rows = thing.rows; rows != 0 && places.size() < limit; rows &= rows - 1)
        places.push_back({thing.node, &table.row(static_cast<std::uint32_t>(std::countr_zero(rows)))});
    }
    return places;
  }

  /// The same thing by thing; the rows of the last may go beyond the limit.
  Result<std::vector<PlaceRows>> match_things(std::string_view pattern, std::size_t limit) {
    if (pattern.empty() || pattern.front() != '/')
      return Error{fmt::format("'{}' is no address: it must begin with /", printable(pattern))};
    if (!is_address_pattern(pattern)) {
      const Result<Place> place = find(shape_, pattern);
      if (!place) return Error{place.error()};
      count_ = 1;
      return std::vector<PlaceRows>{{place->node, place->row == nullptr ? 0 : std::uint64_t{1} << place->row->index}};
    }
    pieces_ = split(pattern.substr(1), '/');
    limit_ = limit;
    const std::size_t places = pieces_.size() * shape_.keys();
    if (budget_.spend(static_cast<int>(std::min<std::size_t>(places / 64, PatternBudget::kMessage)))) {
      been_.assign(places, false);
      walk(shape_.root(), 0);
    }
    if (budget_.over()) {
      return Error{fmt::format("the pattern '{}' is too much work; say more of the path, or send fewer at a time",
                               printable(shortened(pattern, 100)))};
    }
    return std::move(found_);
  }

 private:
  // whether a node's own name is the house's (a group such as `part`, or a singleton such as `sim`) and so compared
  // loosely
  static bool house_name(const Shape& shape, Id id) {
    const std::string& path = shape.table(id).path();
    return path.empty() || path.back() != '>';
  }

  static std::optional<Id> child_named(const Shape& shape, Id parent, std::string_view name) {
    std::optional<Id> found = shape.exact_child(parent, name);
    if (found) return found;
    shape.each_child(parent, [&](Id child) {
      if (!house_name(shape, child)) return false;  // siblings are of one kind; a thousand bodies are not walked
      if (same_name(shape.name(child), name)) found = child;
      return !found;
    });
    return found;
  }

  static std::string near_names(const Shape& shape, Id id, std::string_view name) {
    std::vector<std::string_view> near = shape.table(id).row_names();
    shape.each_child(id, [&](Id other) {
      near.push_back(shape.name(other));
      return true;
    });
    return name_hint(name, near);
  }

  bool over() const { return count_ >= limit_ || budget_.over(); }

  bool name_matches(Id id, std::string_view piece) {
    const std::string_view name = shape_.name(id);
    if (budget_.match(piece, name)) return true;
    const std::string escaped = escape_name(name);
    return escaped != name && budget_.match(piece, escaped);
  }

  // the rows of a class that the last piece means: found once, for all of its things
  std::uint64_t rows_of(const Table& table) {
    if (last_.first == &table) return last_.second;
    const auto [known, fresh] = rows_.try_emplace(&table, 0);
    if (fresh) {
      const std::string_view piece = pieces_.back();
      const bool pattern = is_pattern(piece);
      const Row* const exact = pattern ? nullptr : table.find(piece);
      const std::string plain = plain_name(piece);
      for (const Row& row : table.rows()) {
        const bool meant =
            pattern ? budget_.match(piece, row.name) || budget_.match(plain, plain_name(row.name)) : &row == exact;
        if (meant) known->second |= std::uint64_t{1} << row.index;
      }
    }
    last_ = *known;
    return known->second;
  }

  void rows(Id id) {
    const std::uint64_t rows = rows_of(shape_.table(id));
    if (rows == 0 || over()) return;
    found_.push_back({id, rows});
    count_ += static_cast<std::size_t>(std::popcount(rows));
  }

  void walk(Id id, std::size_t at) {
    if (at >= pieces_.size() || over() || !budget_.spend(PatternBudget::kName)) return;
    if (pieces_[at].empty()) {  // `//`: any depth, this one included
      // several `//` lead to one place by many ways: each is gone once
      const std::size_t place = at * shape_.keys() + shape_.key(id);
      if (been_[place]) return;
      been_[place] = true;
      walk(id, at + 1);
      shape_.each_child(id, [&](Id child) {
        walk(child, at);
        return true;
      });
      return;
    }
    if (at + 1 == pieces_.size()) return rows(id);
    if (!is_pattern(pieces_[at])) {
      if (const auto child = child_named(shape_, id, unescape_name(pieces_[at]))) walk(*child, at + 1);
      return;
    }
    shape_.each_child(id, [&](Id child) {
      if (over()) return false;
      if (name_matches(child, pieces_[at])) walk(child, at + 1);
      return true;
    });
  }

  const Shape& shape_;
  PatternBudget& budget_;
  std::vector<std::string_view> pieces_;
  std::size_t limit_ = 0;
  std::vector<PlaceRows> found_;
  std::size_t count_ = 0;  // of rows
  std::unordered_map<const Table*, std::uint64_t> rows_;
  std::pair<const Table*, std::uint64_t> last_{};  // neighbours are alike
  std::vector<bool> been_;                         // by piece and key
};

}  // namespace limber
