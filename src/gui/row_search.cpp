// Node by node, from the tree's beginning.
#include "gui/row_search.h"

#include <algorithm>
#include <cctype>

#include "base/text.h"

namespace limber {

namespace {

std::string small(std::string_view text) {
  std::string letters(text);
  for (char& c : letters) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

}  // namespace

void RowSearch::look_for(std::string_view words) {
  std::vector<std::string> list;
  for (const std::string_view word : split(words, ' ')) {
    if (!word.empty()) list.push_back(small(word));
  }
  if (list == words_) return;
  words_ = std::move(list);
  tree_ = nullptr;
}

bool RowSearch::fits(std::string_view path, const Row& row) const {
  const std::string row_name = small(row.name);
  return std::all_of(words_.begin(), words_.end(), [&](const std::string& word) {
    if (path.find(word) != std::string_view::npos || row_name.find(word) != std::string::npos) return true;
    // a path that is typed or pasted: its last piece begins the row
    const std::size_t slash = word.rfind('/');
    return slash != std::string::npos && path.ends_with(std::string_view(word).substr(0, slash)) &&
           row_name.find(word.substr(slash + 1)) == 0;
  });
}

void RowSearch::go_on(const std::shared_ptr<const Tree>& tree) {
  if (words_.empty()) return;
  if (tree != tree_) {
    tree_ = tree;
    next_ = 0;
    more_ = false;
    found_.clear();
  }
  const std::size_t end = std::min(tree_->nodes().size(), next_ + kNodesAFrame);
  for (; next_ < end; next_++) {
    const auto node = static_cast<std::uint32_t>(next_);
    const Table& table = *tree_->nodes()[node].table;
    if (table.rows().empty()) continue;
    const std::string path = tree_->path(node);
    const std::string low = small(path);
    for (const Row& row : table.rows()) {
      if (!fits(low, row)) continue;
      if (found_.size() >= kMost) {
        more_ = true;
        next_ = tree_->nodes().size();
        return;
      }
      found_.push_back({{node, &row}, tree_->path(TreePlace{node, &row})});
    }
  }
}

}  // namespace limber
