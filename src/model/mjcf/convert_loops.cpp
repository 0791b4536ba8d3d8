// Converts loops: computes the frames that follow from the home pose, and replaces the world by the link that is fixed
// to it.
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/mjcf/convert.h"

namespace limber::model {

std::vector<Pose> home_poses(const MjcfFile& file) {
  std::vector<Pose> homes(file.bodies.size());
  for (std::size_t i = 1; i < homes.size(); ++i)
    homes[i] = homes[static_cast<std::size_t>(file.bodies[i].parent)] * file.bodies[i].pose;
  return homes;
}

void convert_loops(const MjcfFile& file, const std::vector<int>& link_of, std::size_t root, UrdfFile& out,
                   Problems& problems) {
  if (file.loops.empty()) return;
  const std::vector<Pose> homes = home_poses(file);
  const bool fixed_root = out.fixed_root.value_or(false);
  // the link of a body, with the pose of the body in it; the world's is that of a fixed root
  struct Side {
    int link;
    Pose body_in_link;
  };
  const auto side_of = [&](int body) -> std::optional<Side> {
    const int link = link_of[static_cast<std::size_t>(body)];
    if (link >= 0) return Side{link, {}};
    if (body == 0 && fixed_root) return Side{0, homes[root].inverse()};
    return {};
  };
  std::size_t others = 0;
  const MjcfLoop* first_other = nullptr;
  for (const MjcfLoop& from : file.loops) {
    const std::optional<Side> side_1 = side_of(from.body_1);
    const std::optional<Side> side_2 = side_of(from.body_2);
    if (!side_1 || !side_2) {
      if (others++ == 0) first_other = &from;
      continue;
    }
    const Pose& home_1 = homes[static_cast<std::size_t>(from.body_1)];
    const Pose& home_2 = homes[static_cast<std::size_t>(from.body_2)];
    UrdfLoop loop;
    loop.name = from.name;
    loop.line = from.line;
    loop.type = from.type;
    loop.axis = Vec3(0, 0, 1);
    loop.parent = out.links[static_cast<std::size_t>(side_1->link)].name;
    loop.child = out.links[static_cast<std::size_t>(side_2->link)].name;
    loop.frame_in_parent = side_1->body_in_link * from.frame_1;
    loop.frame_in_child =
        side_2->body_in_link * (from.frame_2 ? *from.frame_2 : home_2.inverse() * home_1 * from.frame_1);
    out.loops.push_back(std::move(loop));
  }
  if (others == 0) return;
  problems.warning(first_other->line,
                   fmt::format("{} to a body that is not part of this tree: {} open",
                               counted(others, "<connect> or <weld> leads", "<connect> or <weld> lead"),
                               plural(others, "the loop stays", "the loops stay")),
                   "Load with root = \"world\", so that all bodies are one body.");
}

}  // namespace limber::model
