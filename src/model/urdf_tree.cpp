// The tree of a URDF: depth first without recursion, each link once.
#include "model/urdf_tree.h"

#include <string>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

class Finder {
 public:
  Finder(const UrdfFile& file, Problems& problems)
      : file_(file), problems_(problems), out_(file.links.size()), is_child_(file.links.size(), false) {}

  Result<std::vector<UrdfNode>> run() {
    connect();
    const std::vector<int> roots = find_roots();
    if (roots.empty()) {
      const int line = file_.joints.empty() ? 1 : file_.joints.front().line;
      return Error{fmt::format(
          "{}: the joints run in a circle: every link is some joint's child, so there is no root. Take the joint out "
          "that leads back to the first link.",
          line)};
    }
    std::vector<UrdfNode> best;
    int best_root = 0;
    visited_.assign(file_.links.size(), -1);
    for (const int root : roots) {
      std::vector<UrdfNode> tree = walk(root);
      if (tree.size() <= best.size()) continue;
      best = std::move(tree);
      best_root = root;
    }
    say_the_rest(roots, best, best_root);
    return best;
  }

 private:
  // joints between links that exist, by parent, in file order
  void connect() {
    std::unordered_map<std::string_view, int> index;
    for (std::size_t i = 0; i < file_.links.size(); ++i) index.emplace(file_.links[i].name, static_cast<int>(i));
    child_of_.assign(file_.joints.size(), -1);
    for (std::size_t j = 0; j < file_.joints.size(); ++j) {
      const UrdfJoint& joint = file_.joints[j];
      const auto parent = index.find(joint.parent);
      const auto child = index.find(joint.child);
      if (parent == index.end() || child == index.end()) {
        const bool is_parent = parent == index.end();
        problems_.error(joint.line,
                        fmt::format("joint '{}': its {} link '{}' does not exist; left out", printable(joint.name),
                                    is_parent ? "parent" : "child", printable(is_parent ? joint.parent : joint.child)),
                        "Write the name of a <link> of this file.");
      } else if (parent == child) {
        problems_.error(joint.line,
                        fmt::format("joint '{}' connects link '{}' to itself; left out", printable(joint.name),
                                    printable(joint.parent)),
                        "Name two different links.");
      } else {
        child_of_[j] = child->second;
        is_child_[static_cast<std::size_t>(child->second)] = true;
        out_[static_cast<std::size_t>(parent->second)].push_back(static_cast<int>(j));
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

  // a link that an earlier root reached is not visited again, so that all walks together are linear
  std::vector<UrdfNode> walk(int root) {
    std::vector<UrdfNode> tree;
    std::vector<UrdfNode> stack{{root, -1, -1}};
    while (!stack.empty()) {
      const UrdfNode node = stack.back();
      stack.pop_back();
      int& seen = visited_[static_cast<std::size_t>(node.link)];
      if (seen >= 0) {
        say_second_parent(node.joint);
        continue;
      }
      seen = root;
      const int at = static_cast<int>(tree.size());
      tree.push_back(node);
      const std::vector<int>& joints = out_[static_cast<std::size_t>(node.link)];
      for (auto j = joints.rbegin(); j != joints.rend(); ++j) {
        stack.push_back({child_of_[static_cast<std::size_t>(*j)], *j, at});
      }
    }
    return tree;
  }

  void say_second_parent(int joint) {
    const UrdfJoint& j = file_.joints[static_cast<std::size_t>(joint)];
    problems_.error(j.line,
                    fmt::format("joint '{}': link '{}' has a parent already, so this would close a loop; left out",
                                printable(j.name), printable(j.child)),
                    "A URDF is a tree: give every link one parent.");
  }

  void say_the_rest(const std::vector<int>& roots, const std::vector<UrdfNode>& tree, int best_root) {
    if (tree.size() == file_.links.size()) return;
    const std::string root = printable(file_.links[static_cast<std::size_t>(best_root)].name);
    for (std::size_t i = 0; i < file_.links.size(); ++i) {
      if (visited_[i] == best_root) continue;
      const UrdfLink& link = file_.links[i];
      const char* why = visited_[i] < 0 ? "is part of a loop that hangs on nothing" : "is not connected to it";
      problems_.error(link.line,
                      fmt::format("link '{}' {} (the root is '{}'{}); left out", printable(link.name), why, root,
                                  roots.size() > 1 ? fmt::format(", one of {}", roots.size()) : ""),
                      "Connect it with a joint to a link of the tree, or take it out.");
    }
  }

  const UrdfFile& file_;
  Problems& problems_;
  std::vector<std::vector<int>> out_;  // joints that leave a link
  std::vector<bool> is_child_;
  std::vector<int> child_of_;  // by joint; -1: left out
  std::vector<int> visited_;   // by link: the root it was reached from
};

}  // namespace

Result<std::vector<UrdfNode>> find_tree(const UrdfFile& file, Problems& problems) {
  return Finder(file, problems).run();
}

}  // namespace limber
