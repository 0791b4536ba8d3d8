// Both trees are walked side by side, by names: a reset makes the same things anew, and nothing has changed then.
#include "query/notices.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "query/row_face.h"

namespace limber {

namespace {

struct Notice {
  std::string_view command;
  std::string path;
};

class Comparison {
 public:
  Comparison(const Tree& before, const Tree& after) : before_(before), after_(after) {}

  void things(std::uint32_t a, std::uint32_t b) {
    const Table& old_table = *before_.nodes()[a].table;
    const Table& new_table = *after_.nodes()[b].table;
    if (&old_table != &new_table) rows(a, old_table, b, new_table);
    if (same_names(a, b)) return pairwise(a, b);
    std::unordered_map<std::string_view, std::uint32_t> old_children;
    before_.each_child(a, [&](std::uint32_t child) { return old_children.emplace(before_.name(child), child).second; });
    after_.each_child(b, [&](std::uint32_t child) {
      const auto known = old_children.find(after_.name(child));
      if (known == old_children.end()) {
        add("PATH_ADDED", after_.path(child));
      } else {
        things(known->second, child);
        old_children.erase(known);
      }
      return true;
    });
    before_.each_child(a, [&](std::uint32_t child) {
      if (old_children.contains(before_.name(child))) add("PATH_REMOVED", before_.path(child));
      return true;
    });
  }

  const std::vector<Notice>& notices() const { return notices_; }

 private:
  void add(std::string_view command, std::string path) { notices_.push_back({command, std::move(path)}); }

  void rows(std::uint32_t a, const Table& old_table, std::uint32_t b, const Table& new_table) {
    const auto named = [](const Table& table, const std::string& name) {
      const auto rows = table.rows();
      const auto found = std::ranges::find_if(rows, [&](const Row& row) { return row.name == name; });
      return found == rows.end() ? nullptr : &*found;
    };
    for (const Row& row : old_table.rows()) {
      if (named(new_table, row.name) == nullptr) add("PATH_REMOVED", before_.path({a, &row}));
    }
    for (const Row& row : new_table.rows()) {
      const Row* const old = named(old_table, row.name);
      if (old == nullptr) {
        add("PATH_ADDED", after_.path({b, &row}));
      } else if (attributes_text(*old) != attributes_text(row)) {
        add("PATH_CHANGED", after_.path({b, &row}));
      }
    }
  }

  bool same_names(std::uint32_t a, std::uint32_t b) const {
    std::uint32_t x = a + 1;
    std::uint32_t y = b + 1;
    while (x < before_.nodes()[a].end && y < after_.nodes()[b].end) {
      if (before_.name(x) != after_.name(y)) return false;
      x = before_.nodes()[x].end;
      y = after_.nodes()[y].end;
    }
    return x == before_.nodes()[a].end && y == after_.nodes()[b].end;
  }

  void pairwise(std::uint32_t a, std::uint32_t b) {
    std::uint32_t y = b + 1;
    before_.each_child(a, [&](std::uint32_t x) {
      things(x, y);
      y = after_.nodes()[y].end;
      return true;
    });
  }

  const Tree& before_;
  const Tree& after_;
  std::vector<Notice> notices_;
};

// the longest path that all of them lie in
std::string common_parent(const std::vector<Notice>& notices) {
  std::string_view common = notices.front().path;
  common = common.substr(0, common.rfind('/'));
  for (const Notice& n : notices) {
    while (!common.empty() && !(n.path.starts_with(common) && n.path[common.size()] == '/'))
      common = common.substr(0, common.rfind('/'));
  }
  return common.empty() ? "/" : std::string(common);
}

std::string frame(std::string_view command, std::string_view path) {
  return fmt::format(R"({{"COMMAND":"{}","DATA":{}}})", command, json_text(path));
}

}  // namespace

std::vector<std::string> notices_between(const Tree& before, const Tree& after) {
  Comparison comparison(before, after);
  comparison.things(0, 0);
  const std::vector<Notice>& notices = comparison.notices();
  if (notices.size() > kMostNotices) return {frame("PATH_CHANGED", common_parent(notices))};
  std::vector<std::string> frames;
  frames.reserve(notices.size());
  for (const Notice& n : notices) frames.push_back(frame(n.command, n.path));
  return frames;
}

}  // namespace limber
