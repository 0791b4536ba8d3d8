// Iterative depth-first search for the tree of a URDF; visits each link once.
#include "model/urdf/tree.h"

#include <string>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::model {

namespace {

class TreeFinder {
 public:
  TreeFinder(const UrdfFile& file, Problems& problems)
      : file_(file), problems_(problems), outgoing_joints_(file.links.size()), is_child_(file.links.size(), false) {}

  Result<std::vector<UrdfNode>> run() {
    connect();
    const std::vector<int> roots = find_roots();
    if (roots.empty()) {
      const int line = file_.joints.empty() ? 1 : file_.joints.front().line;
      return Error{
          fmt::format("{}: the joints form a cycle: every link is a child, so there is no root. Remove the joint "
                      "that leads back to the first link.",
                      line)};
    }
    std::vector<UrdfNode> best;
    int best_root = 0;
    reached_from_.assign(file_.links.size(), -1);
    for (const int root : roots) {
      std::vector<UrdfNode> tree = walk(root);
      if (tree.size() <= best.size()) continue;
      best = std::move(tree);
      best_root = root;
    }
    report_unconnected(roots, best, best_root);
    return best;
  }

 private:
  // collects the valid joints by parent link, in file order
  void connect() {
    std::unordered_map<std::string_view, int> index;
    for (std::size_t i = 0; i < file_.links.size(); ++i) index.emplace(file_.links[i].name, static_cast<int>(i));
    child_links_.assign(file_.joints.size(), -1);
    for (std::size_t j = 0; j < file_.joints.size(); ++j) {
      const UrdfJoint& joint = file_.joints[j];
      const auto parent = index.find(joint.parent);
      const auto child = index.find(joint.child);
      if (parent == index.end() || child == index.end()) {
        const bool is_parent = parent == index.end();
        problems_.error(joint.line,
                        fmt::format("joint '{}': its {} link '{}' does not exist; ignored", printable(joint.name),
                                    is_parent ? "parent" : "child", printable(is_parent ? joint.parent : joint.child)),
                        "Write the name of a <link> of this file.");
      } else if (parent == child) {
        problems_.error(joint.line,
                        fmt::format("joint '{}' connects link '{}' to itself; ignored", printable(joint.name),
                                    printable(joint.parent)),
                        "Name two different links.");
      } else {
        child_links_[j] = child->second;
        is_child_[static_cast<std::size_t>(child->second)] = true;
        outgoing_joints_[static_cast<std::size_t>(parent->second)].push_back(static_cast<int>(j));
      }
    }
  }

  std::vector<int> find_roots() const {
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child_.size(); ++i) {
      if (!is_child_[i]) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }

  // links reached from an earlier root are not visited again, so that all walks together take linear time
  std::vector<UrdfNode> walk(int root) {
    std::vector<UrdfNode> tree;
    std::vector<UrdfNode> stack{{root, -1, -1}};
    while (!stack.empty()) {
      const UrdfNode node = stack.back();
      stack.pop_back();
      int& visited_from = reached_from_[static_cast<std::size_t>(node.link)];
      if (visited_from >= 0) {
        report_second_parent(node.joint);
        continue;
      }
      visited_from = root;
      const int at = static_cast<int>(tree.size());
      tree.push_back(node);
      const std::vector<int>& joints = outgoing_joints_[static_cast<std::size_t>(node.link)];
      for (auto j = joints.rbegin(); j != joints.rend(); ++j) {
        stack.push_back({child_links_[static_cast<std::size_t>(*j)], *j, at});
      }
    }
    return tree;
  }

  void report_second_parent(int joint) {
    const UrdfJoint& j = file_.joints[static_cast<std::size_t>(joint)];
    problems_.error(j.line,
                    fmt::format("joint '{}': link '{}' has a parent already, so this would close a loop; ignored",
                                printable(j.name), printable(j.child)),
                    "A URDF is a tree: give every link one parent.");
  }

  void report_unconnected(const std::vector<int>& roots, const std::vector<UrdfNode>& tree, int best_root) {
    if (tree.size() == file_.links.size()) return;
    const std::string root = printable(file_.links[static_cast<std::size_t>(best_root)].name);
    for (std::size_t i = 0; i < file_.links.size(); ++i) {
      if (reached_from_[i] == best_root) continue;
      const UrdfLink& link = file_.links[i];
      const char* reason = reached_from_[i] < 0 ? "is part of an unconnected loop" : "is not connected to the tree";
      problems_.error(link.line,
                      fmt::format("link '{}' {} (the root is '{}'{}); ignored", printable(link.name), reason, root,
                                  roots.size() > 1 ? fmt::format(", one of {}", roots.size()) : ""),
                      "Connect it with a joint to a link of the tree, or remove it.");
    }
  }

  const UrdfFile& file_;
  Problems& problems_;
  std::vector<std::vector<int>> outgoing_joints_;  // by link: joints to its children
  std::vector<bool> is_child_;
  std::vector<int> child_links_;   // by joint: its child link; -1: invalid joint
  std::vector<int> reached_from_;  // by link: the root it was reached from; -1: none
};

}  // namespace

Result<std::vector<UrdfNode>> find_tree(const UrdfFile& file, Problems& problems) {
  return TreeFinder(file, problems).run();
}

}  // namespace limber::model
