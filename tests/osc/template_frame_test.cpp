// Templates of messages: addresses, order, signs, units and grouping of the values, in the messages of a small world.
#include "net/osc/templates/template_frame.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/text.h"
#include "net/osc/packets/decode.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "support/world_objects.h"

namespace limber::osc {
namespace {

// Two bodies of two static parts: part k of body b is at (b, k, 10).
struct TemplateFixture {
  TemplateFixture() {
    model::ShapeModel ball;
    ball.kind = model::ShapeKind::sphere;
    ball.radius = 0.1;
    sim::Shape& shape = *world.shapes().add("ball", ball).value();
    for (int b = 1; b <= 2; b++) {
      sim::Body& body = *world.add_body("body " + std::to_string(b)).value();
      for (int k = 1; k <= 2; k++) {
        const Pose pose{{1.0 * b, 1.0 * k, 10}, quat_identity()};
        (void)body.add_part("part" + std::to_string(k), shape, 0, pose).value();
      }
    }
    world.flush();
  }
  engine::ValueSnapshot values() {
    engine::ValueSnapshot snapshot;
    snapshot.tree = std::make_shared<TreeSnapshot>(store);
    auto tick = std::make_shared<engine::Snapshot>();
    tick->transient.assign(store.transient_values().begin(), store.transient_values().end());
    snapshot.snapshot = std::move(tick);
    snapshot.persistent.assign(store.persistent_values().begin(), store.persistent_values().end());
    snapshot.computed.assign(snapshot.tree->computed_width(), 0);
    return snapshot;
  }
  // Returns the messages as text, by datagram.
  std::vector<std::vector<std::string>> messages(std::vector<StreamMessage> templates, int bundle = -1) {
    StreamTarget target;
    target.messages = std::move(templates);
    target.bundle = bundle;
    const engine::ValueSnapshot snapshot = values();
    frame.lay_out(snapshot.tree, target);
    frame.fill(snapshot);
    std::vector<std::vector<std::string>> list;
    const char* at = frame.bytes().data();
    for (const std::uint32_t size : frame.datagram_sizes()) {
      const Result<Decoded> decoded = decode_packet(at, size);
      EXPECT_TRUE(decoded.ok()) << (decoded ? "" : decoded.error());
      at += size;
      list.emplace_back();
      if (!decoded) continue;
      for (const auto& message : decoded->messages) list.back().push_back(text_of(message));
    }
    EXPECT_EQ(at, frame.bytes().data() + frame.bytes().size());
    return list;
  }
  template <class M>
  static std::string text_of(const M& m) {
    std::string text = m.address;
    for (const Arg& arg : m.args) text += " " + (arg.is_text() ? arg.text : number_text(arg.number));
    return text;
  }

  Store store;
  sim::World world{store};
  TemplateFrame frame;
};

using Texts = std::vector<std::vector<std::string>>;

TEST(TemplateFrame, SendsOneMessagePerObject) {
  TemplateFixture f;
  const StreamMessage wanted{"/m/{body}/{name}/{index}", "/physics/body/*/part/*", {"position"}, 1, false};
  EXPECT_EQ(f.messages({wanted}), (Texts{{"/m/body%201/part1/1 1 1 10", "/m/body%201/part2/2 1 2 10",
                                          "/m/body%202/part1/1 2 1 10", "/m/body%202/part2/2 2 2 10"}}));
  EXPECT_EQ(f.messages({wanted}, 0).size(), 4u) << "without bundles, each message is a datagram";
  EXPECT_TRUE(f.frame.problems().empty());
}

TEST(TemplateFrame, SendsOneMessagePerBody) {
  TemplateFixture f;
  EXPECT_EQ(f.messages({{"/m/{body}", "/physics/body/*/part/*", {"{name}", "position.y"}, 1, true}}),
            (Texts{{"/m/body%201 part1 1 part2 2", "/m/body%202 part1 1 part2 2"}}));
}

// From z up to y up, in cm, with w first.
TEST(TemplateFrame, OrdersAxesAndScales) {
  TemplateFixture f;
  const StreamMessage place{
      "/p", "/physics/body/body%202/part/part1", {"{body}", "position.x", "position.z", "-position.y"}, 100, false};
  const StreamMessage rotation{
      "/r", "/physics/body/body%202/part/part1", {"rotation.w", "rotation.x", "-rotation.y", "rotation.z"}, 1, false};
  EXPECT_EQ(f.messages({place, rotation}), (Texts{{"/p body 2 200 1000 -100", "/r 1 0 0 0"}}));
  EXPECT_EQ(f.messages({{"/s", "/physics/sim", {"timestep", "gravity.z"}, 1, false}}).front().size(), 1u)
      << "settings of any object";
}

TEST(TemplateFrame, FollowsValuesAndTheTree) {
  TemplateFixture f;
  const StreamMessage wanted{"/f", "/physics/body/*/part/part1", {"friction"}, 1, false};
  const double friction = 0.75;
  const NodeId part = f.world.find_body("body 1")->find_part("part1")->id();
  ASSERT_TRUE(f.store.set(part, "friction", {&friction, 1}).ok());
  EXPECT_EQ(f.messages({wanted}), (Texts{{"/f 0.75", "/f 0.5"}}));
  f.world.remove_body(*f.world.find_body("body 2"));
  EXPECT_EQ(f.messages({wanted}), (Texts{{"/f 0.75"}}));
}

TEST(TemplateFrame, SplitsBundlesAtTheirSize) {
  TemplateFixture f;
  const StreamMessage wanted{"/m/{body}/{name}", "/physics/body/*/part/*", {"position"}, 1, false};
  const Texts split = f.messages({wanted}, 100);
  EXPECT_GT(split.size(), 1u);
  for (const std::uint32_t size : f.frame.datagram_sizes()) EXPECT_LE(size, 100u);
  std::size_t count = 0;
  for (const auto& datagram : split) count += datagram.size();
  EXPECT_EQ(count, 4u);
}

TEST(TemplateFrame, ReportsUnknownNames) {
  TemplateFixture f;
  (void)f.messages({{"/a", "/physics/body/*/part/*", {"positon"}, 1, false},
                    {"/b", "/physics/body/*/part/nose", {"position"}, 1, false},
                    {"/c", "/physics/body/*/part/*", {"position.w"}, 1, false},
                    {"/d", "/physics/body/*/part/*", {"friction.x"}, 1, false}});
  ASSERT_EQ(f.frame.problems().size(), 4u);
  EXPECT_EQ(f.frame.problems()[0],
            "positon of /physics/body/body%201/part/part1: there is no 'positon'; did you mean 'position'?");
  EXPECT_EQ(f.frame.problems()[1], "/b: no object matches '/physics/body/*/part/nose'");
  EXPECT_NE(f.frame.problems()[2].find("there is no component 'w'"), std::string::npos);
  EXPECT_NE(f.frame.problems()[3].find("there is no component 'x'"), std::string::npos);
  EXPECT_TRUE(f.frame.bytes().empty());
}

}  // namespace
}  // namespace limber::osc
