// PathMatcher: path and pattern lookup over the store and over copies of its structure.
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
#include "properties/pattern_budget.h"
#include "properties/property_table.h"

namespace limber {

/// True if the address is a pattern, which may match several properties, rather than a path.
inline bool is_address_pattern(std::string_view address) {
  return address.find_first_of("?*[{") != std::string_view::npos || address.find("//") != std::string_view::npos;
}

/// Looks up paths and patterns in a tree. A Tree is an adapter of the store or of a copy. It has the types `Ref`
/// (node, property) and `Set` (node, bit mask of properties), and for nodes root(), name(), table(), path(), key() (a
/// unique number below keys()), exact_child() (the child of exactly that name, if any) and each_child(), which stops
/// when its function returns false. An object is used for one lookup.
template <class Tree>
class PathMatcher {
 public:
  using Ref = typename Tree::Ref;
  using Set = typename Tree::Set;
  using Id = decltype(Ref::node);

  PathMatcher(const Tree& tree, PatternBudget& budget) : tree_(tree), budget_(budget) {}

  /// Returns the property or node at an exact path. `hint`: the error lists similar names, which visits all siblings.
  static Result<Ref> find(const Tree& tree, std::string_view path, bool hint = true) {
    if (path.empty() || path.front() != '/')
      return Error{fmt::format("'{}' is not an address: it must begin with /", printable(path))};
    if (path.back() == '/') path.remove_suffix(1);
    Id node = tree.root();
    const std::vector<std::string_view> pieces =
        path.empty() ? std::vector<std::string_view>{} : split(path.substr(1), '/');
    for (std::size_t i = 0; i < pieces.size(); i++) {
      const std::string name = unescape_name(pieces[i]);
      if (const auto child = child_named(tree, node, name)) {
        node = *child;
        continue;
      }
      const Property* property = tree.table(node).find(name);
      if (property != nullptr && i + 1 == pieces.size()) return Ref{node, property};
      return Error{fmt::format("there is no '{}' in {}{}", printable(name), tree.path(node),
                               hint ? similar_names(tree, node, name) : "")};
    }
    return Ref{node, nullptr};
  }

  /// Returns the properties and nodes that match, in tree order, at most `limit`.
  Result<std::vector<Ref>> match(std::string_view pattern, std::size_t limit) {
    const Result<std::vector<Set>> sets = match_nodes(pattern, limit);
    if (!sets) return Error{sets.error()};
    std::vector<Ref> refs;
    refs.reserve(std::min(count_, limit));
    for (const Set& set : *sets) {
      if (set.properties == 0) refs.push_back({set.node, nullptr});
      const PropertyTable& table = tree_.table(set.node);
      for (std::uint64_t remaining = set.properties; remaining != 0 && refs.size() < limit; remaining &= remaining - 1)
        refs.push_back({set.node, &table.property(static_cast<std::uint32_t>(std::countr_zero(remaining)))});
    }
    return refs;
  }

  /// Like match(), with one result per node. The properties of the last one may exceed the limit.
  Result<std::vector<Set>> match_nodes(std::string_view pattern, std::size_t limit) {
    if (pattern.empty() || pattern.front() != '/')
      return Error{fmt::format("'{}' is not an address: it must begin with /", printable(pattern))};
    if (!is_address_pattern(pattern)) {
      const Result<Ref> ref = find(tree_, pattern);
      if (!ref) return Error{ref.error()};
      count_ = 1;
      return std::vector<Set>{{ref->node, ref->property == nullptr ? 0 : std::uint64_t{1} << ref->property->index}};
    }
    pieces_ = split(pattern.substr(1), '/');
    limit_ = limit;
    const std::size_t flags = pieces_.size() * tree_.keys();
    if (budget_.charge(static_cast<int>(std::min<std::size_t>(flags / 64, PatternBudget::kStepsPerMessage)))) {
      visited_.assign(flags, false);
      walk(tree_.root(), 0);
    }
    if (budget_.exceeded()) {
      return Error{fmt::format("the pattern '{}' needs too much work; make it more specific, or send fewer at a time",
                               printable(shortened(pattern, 100)))};
    }
    return std::move(results_);
  }

 private:
  // True if the program defines the node's name (a group such as `part`, or a singleton such as `sim`). Such names are
  // compared as same_name() does.
  static bool is_fixed_name(const Tree& tree, Id id) {
    const std::string& path = tree.table(id).path();
    return path.empty() || path.back() != '>';
  }

  static std::optional<Id> child_named(const Tree& tree, Id parent, std::string_view name) {
    std::optional<Id> found = tree.exact_child(parent, name);
    if (found) return found;
    tree.each_child(parent, [&](Id child) {
      if (!is_fixed_name(tree, child)) return false;  // siblings are alike: skip them all
      if (same_name(tree.name(child), name)) found = child;
      return !found;
    });
    return found;
  }

  static std::string similar_names(const Tree& tree, Id id, std::string_view name) {
    std::vector<std::string_view> near = tree.table(id).property_names();
    tree.each_child(id, [&](Id other) {
      near.push_back(tree.name(other));
      return true;
    });
    return name_hint(name, near);
  }

  bool exceeded() const { return count_ >= limit_ || budget_.exceeded(); }

  bool name_matches(Id id, std::string_view piece) {
    const std::string_view name = tree_.name(id);
    if (budget_.match(piece, name)) return true;
    const std::string escaped = escape_name(name);
    return escaped != name && budget_.match(piece, escaped);
  }

  // The properties of a class that match the last component of the pattern; computed once per class.
  std::uint64_t matching_properties(const PropertyTable& table) {
    if (last_match_.first == &table) return last_match_.second;
    const auto [entry, inserted] = matches_by_table_.try_emplace(&table, 0);
    if (inserted) {
      const std::string_view piece = pieces_.back();
      const bool pattern = is_pattern(piece);
      const Property* const exact = pattern ? nullptr : table.find(piece);
      const std::string plain = normalized_name(piece);
      for (const Property& property : table.properties()) {
        const bool matches =
            pattern ? budget_.match(piece, property.name) || budget_.match(plain, normalized_name(property.name))
                    : &property == exact;
        if (matches) entry->second |= std::uint64_t{1} << property.index;
      }
    }
    last_match_ = *entry;
    return entry->second;
  }

  void add_properties(Id id) {
    const std::uint64_t properties = matching_properties(tree_.table(id));
    if (properties == 0 || exceeded()) return;
    results_.push_back({id, properties});
    count_ += static_cast<std::size_t>(std::popcount(properties));
  }

  void walk(Id id, std::size_t piece) {
    if (piece >= pieces_.size() || exceeded() || !budget_.charge(PatternBudget::kStepsPerName)) return;
    if (pieces_[piece].empty()) {  // `//`: any depth, including none
      // With several `//`, a node is reached in many ways; it is visited once per component.
      const std::size_t flag = piece * tree_.keys() + tree_.key(id);
      if (visited_[flag]) return;
      visited_[flag] = true;
      walk(id, piece + 1);
      tree_.each_child(id, [&](Id child) {
        walk(child, piece);
        return true;
      });
      return;
    }
    if (piece + 1 == pieces_.size()) return add_properties(id);
    if (!is_pattern(pieces_[piece])) {
      if (const auto child = child_named(tree_, id, unescape_name(pieces_[piece]))) walk(*child, piece + 1);
      return;
    }
    tree_.each_child(id, [&](Id child) {
      if (exceeded()) return false;
      if (name_matches(child, pieces_[piece])) walk(child, piece + 1);
      return true;
    });
  }

  const Tree& tree_;
  PatternBudget& budget_;
  std::vector<std::string_view> pieces_;
  std::size_t limit_ = 0;
  std::vector<Set> results_;
  std::size_t count_ = 0;  // of properties
  std::unordered_map<const PropertyTable*, std::uint64_t> matches_by_table_;
  std::pair<const PropertyTable*, std::uint64_t> last_match_{};  // consecutive nodes mostly have the same table
  std::vector<bool> visited_;                                    // by pattern component and node key
};

}  // namespace limber
