// The mass table: a part's center of mass in its link, by the slot of its node.
#include "sim/neighbors/mass_table.h"

#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(MassTable, ContainsTheValuesOfEachPart) {
  WorldFixture s;
  MassTable::View view;
  Part& one = s.add_single_part(sphere_model(0.5), 2);
  s.world.mass_table().register_view(view);
  const auto solid = [&](const Part& part) { return view.list[view.index_of_slot[part.id().slot]]; };
  // 2/5 r² for 1 kg
  EXPECT_DOUBLE_EQ(solid(one).unit_inertia[0], 0.1);
  EXPECT_EQ(solid(one).center[2], 0);
  std::vector<Part*> more;
  for (int i = 1; i < 40; i++) {
    more.push_back(&s.add_single_part(sphere_model(0.5 + i), 2, {{100.0 * i, 0, 0}, quat_identity()}));
  }
  for (int i = 1; i < 40; i++) {
    EXPECT_DOUBLE_EQ(solid(*more[static_cast<std::size_t>(i - 1)]).unit_inertia[1], 0.4 * (0.5 + i) * (0.5 + i));
  }
  // a part that reuses a released element
  s.world.remove_body(one.body());
  Part& last = s.add_single_part(sphere_model(1), 2);
  EXPECT_DOUBLE_EQ(solid(last).unit_inertia[2], 0.4);
  s.world.mass_table().unregister_view(view);
}

}  // namespace
}  // namespace limber::sim
