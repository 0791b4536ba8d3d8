// Depth-first order of a body's links.
#include "export/motion.h"

#include <algorithm>
#include <utility>

namespace limber::exporter {

LinkOrder link_order(const MotionBody& body) {
  std::vector<std::vector<std::size_t>> children(body.links.size());
  std::vector<std::pair<std::size_t, std::size_t>> stack;  // link, depth
  for (std::size_t i = body.links.size(); i-- > 0;) {
    const int parent = body.links[i].parent;
    if (parent < 0) {
      stack.emplace_back(i, 0);
    } else {
      children[static_cast<std::size_t>(parent)].push_back(i);
    }
  }
  LinkOrder order;
  while (!stack.empty()) {
    const auto [link, depth] = stack.back();
    stack.pop_back();
    order.links.push_back(link);
    order.depth.push_back(depth);
    for (const std::size_t child : children[link]) stack.emplace_back(child, depth + 1);
  }
  return order;
}

}  // namespace limber::exporter
