// Addresses to places: an exact walk, and a walk by pattern.
#include "params/catalog.h"

#include <unordered_set>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

// whether a node's own name is the house's (a group such as `part`, or a singleton such as `sim`) and so compared
// loosely
bool house_name(const Store& store, NodeId id) {
  if (store.is_group(id)) return true;
  const std::string& path = store.table(id).path();
  return path.empty() || path.back() != '>';
}

NodeId child_named(const Store& store, NodeId parent, std::string_view name) {
  if (const NodeId exact = store.child(parent, name); !exact.null()) return exact;
  for (const NodeId child : store.children(parent)) {
    if (!house_name(store, child)) break;  // siblings are of one kind; a thousand bodies are not walked
    if (same_name(store.name(child), name)) return child;
  }
  return {};
}

struct PatternWalk {
  const Store& store;
  std::vector<std::string_view> pieces;
  std::size_t limit;
  std::vector<Place> found;
  std::unordered_set<std::uint64_t> been;  // several `//` lead to one place by many ways: each is gone once
  int spent = 0;
  static constexpr int kMost = 20000000;  // names looked at and steps of matching: a fraction of a second

  bool over() { return found.size() >= limit || ++spent > kMost; }
  bool name_matches(NodeId id, std::string_view piece) {
    const std::string& name = store.name(id);
    if (!is_pattern(piece)) {
      const bool exact = name == piece || name == unescape_name(piece);
      return exact || (house_name(store, id) && same_name(name, piece));
    }
    return pattern_match(piece, name, &spent) || pattern_match(piece, escape_name(name), &spent);
  }

  void rows(NodeId id, std::string_view piece) {
    const bool pattern = is_pattern(piece);
    const std::string plain = pattern ? plain_name(piece) : "";
    for (const Row& row : store.table(id).rows()) {
      if (over()) return;
      const bool hit =
          pattern ? pattern_match(piece, row.name, &spent) || pattern_match(plain, plain_name(row.name), &spent)
                  : same_name(row.name, piece);
      if (hit) found.push_back({id, &row});
    }
  }

  void walk(NodeId id, std::size_t at) {
    if (at >= pieces.size() || over()) return;
    if (pieces[at].empty()) {  // `//`: any depth, this one included
      if (!been.insert(std::uint64_t{id.slot} << 32 | at).second) return;
      walk(id, at + 1);
      for (const NodeId child : store.children(id)) walk(child, at);
      return;
    }
    if (at + 1 == pieces.size()) rows(id, pieces[at]);
    if (at + 1 == pieces.size()) return;
    if (!is_pattern(pieces[at])) {
      const NodeId child = child_named(store, id, unescape_name(pieces[at]));
      if (!child.null()) walk(child, at + 1);
      return;
    }
    for (const NodeId child : store.children(id)) {
      if (over()) return;
      if (name_matches(child, pieces[at])) walk(child, at + 1);
    }
  }
};

}  // namespace

Result<Place> find_place(const Store& store, std::string_view path) {
  if (path.empty() || path.front() != '/') return Error{fmt::format("'{}' is no address: it must begin with /", path)};
  if (path.size() > 1 && path.back() == '/') path.remove_suffix(1);
  NodeId at = store.root();
  const std::vector<std::string_view> pieces = split(path.substr(1), '/');
  for (std::size_t i = 0; i < pieces.size(); i++) {
    const std::string name = unescape_name(pieces[i]);
    const NodeId child = child_named(store, at, name);
    if (!child.null()) {
      at = child;
      continue;
    }
    const Row* row = store.table(at).find(name);
    if (row != nullptr && i + 1 == pieces.size()) return Place{at, row};
    std::vector<std::string_view> near = store.table(at).row_names();
    for (const NodeId other : store.children(at)) near.push_back(store.name(other));
    return Error{fmt::format("there is no '{}' in {}{}", name, store.path(at), name_hint(name, near))};
  }
  return Place{at, nullptr};
}

Result<std::vector<Place>> match_places(const Store& store, std::string_view pattern, std::size_t limit) {
  if (pattern.empty() || pattern.front() != '/')
    return Error{fmt::format("'{}' is no address: it must begin with /", pattern)};
  if (pattern.find_first_of("?*[{") == std::string_view::npos && pattern.find("//") == std::string_view::npos) {
    const Result<Place> place = find_place(store, pattern);
    if (!place) return Error{place.error()};
    return std::vector<Place>{*place};
  }
  PatternWalk walk{store, split(pattern.substr(1), '/'), limit, {}, {}};
  walk.walk(store.root(), 0);
  return std::move(walk.found);
}

}  // namespace limber
