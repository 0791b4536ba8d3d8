// Searches node by node in tree order.
#include "ui/panel/widgets/property_search.h"

#include <algorithm>
#include <cctype>

#include "base/text.h"

namespace limber::panel {

namespace {

std::string to_lower(std::string_view text) {
  std::string letters(text);
  for (char& c : letters) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

}  // namespace

void PropertySearch::start(std::string_view words) {
  std::vector<std::string> new_words;
  for (const std::string_view word : split(words, ' ')) {
    if (!word.empty()) new_words.push_back(to_lower(word));
  }
  if (new_words == words_) return;
  words_ = std::move(new_words);
  tree_ = nullptr;
}

bool PropertySearch::matches(std::string_view path, const Property& property) const {
  const std::string property_name = to_lower(property.name);
  return std::all_of(words_.begin(), words_.end(), [&](const std::string& word) {
    if (path.find(word) != std::string_view::npos || property_name.find(word) != std::string::npos) return true;
    // a typed or pasted path: its last component is the beginning of a property name
    const std::size_t slash = word.rfind('/');
    return slash != std::string::npos && path.ends_with(std::string_view(word).substr(0, slash)) &&
           property_name.find(word.substr(slash + 1)) == 0;
  });
}

void PropertySearch::advance(const std::shared_ptr<const TreeSnapshot>& tree) {
  if (words_.empty()) return;
  if (tree != tree_) {
    tree_ = tree;
    next_ = 0;
    more_ = false;
    found_.clear();
  }
  const std::size_t end = std::min(tree_->nodes().size(), next_ + kNodesPerFrame);
  for (; next_ < end; next_++) {
    const auto node = static_cast<std::uint32_t>(next_);
    const PropertyTable& table = *tree_->nodes()[node].table;
    if (table.properties().empty()) continue;
    const std::string path = tree_->path(node);
    const std::string low = to_lower(path);
    for (const Property& property : table.properties()) {
      if (!matches(low, property)) continue;
      if (found_.size() >= kMaxResults) {
        more_ = true;
        next_ = tree_->nodes().size();
        return;
      }
      found_.push_back({{node, &property}, tree_->path(TreePropertyRef{node, &property})});
    }
  }
}

}  // namespace limber::panel
