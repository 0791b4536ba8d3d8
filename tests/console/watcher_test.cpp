// Subscriptions: messages, and differences between two value snapshots.
#include "net/console/subscription.h"

#include "engine/show.h"

namespace limber::console {
namespace {

using engine::test::Show;
using RequestKind = ConsoleRequest::Kind;

constexpr const char* kWatchedScene = R"(
params { { "wind", 2, min = 0, max = 10 }, { "sun", 0 } }
local ball = sim:add_sphere_shape("ball", 0.1)
osc:on("/later", function() sim:after(0.02, function() params.sun = 1 end) end)
sim:add_body("one"):add_part("p", ball, { position = vec3(0, 0, 5) })
osc:on("/more", function() sim:body("one"):copy("two") end)
osc:on("/less", function() sim:body("two"):remove() end)
)";

struct Subscriber {
  explicit Subscriber(engine::EngineLink& link, RequestKind kind, const std::string& pattern = "") {
    Result<std::unique_ptr<Subscription>> made = make_subscription(link, {1, kind, pattern});
    EXPECT_TRUE(made.ok());
    if (made) subscription = std::move(*made);
  }
  /// Returns the new lines, as protocol lines.
  std::vector<ConsoleLine> new_lines() {
    std::vector<ConsoleLine> result;
    subscription->poll([&](const std::string& line) { result.push_back(*parse_line(line.substr(0, line.size() - 1))); },
                       [&](std::uint64_t count) { dropped += count; });
    return result;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> all;
    for (const ConsoleLine& line : new_lines()) all.push_back(line.text);
    return all;
  }
  std::unique_ptr<Subscription> subscription;
  std::uint64_t dropped = 0;
};

using Texts = std::vector<std::string>;

// waits for a snapshot that includes everything sent so far
void wait_for_snapshot(Show& show) {
  const std::uint64_t wanted = show.link.value_snapshot_requests.load();
  for (int i = 0; i < 1000000; i++) {
    show.ticks(1);
    const auto made = show.link.value_snapshots.read();
    if (made != nullptr && made->request >= wanted) return;
  }
  ADD_FAILURE() << "no snapshot was taken";
}

TEST(Subscription, SendsMatchingMessages) {
  engine::EngineLink link;
  link.message_log.add(true, "a:1", {"/before", {}});
  Subscriber all(link, RequestKind::traffic);
  Subscriber parts(link, RequestKind::traffic, "/physics/*/mass");
  EXPECT_TRUE(link.message_log.enabled());
  link.message_log.add(true, "a:1", {"/physics/part/mass", {Arg::of("arm"), Arg::of(0.3)}});
  link.message_log.add(false, "b:2", {"/pong", {}});
  const std::vector<ConsoleLine> lines = all.new_lines();
  ASSERT_EQ(lines.size(), 2u) << "no messages from before the subscription";
  EXPECT_EQ(lines[0].kind, ConsoleLine::Kind::in);
  EXPECT_EQ(lines[0].text, "/physics/part/mass arm 0.3");
  EXPECT_EQ(lines[0].origin, "a:1");
  EXPECT_GT(lines[0].time, 0);
  EXPECT_EQ(lines[1].kind, ConsoleLine::Kind::out);
  EXPECT_TRUE(all.new_lines().empty());
  EXPECT_EQ(parts.texts(), Texts{"/physics/part/mass arm 0.3"});
  for (std::size_t i = 0; i < engine::MessageLog::kMaxEntries + 7; i++) link.message_log.add(true, "", {"/flood", {}});
  EXPECT_EQ(all.new_lines().size(), engine::MessageLog::kMaxEntries);
  EXPECT_EQ(all.dropped, 7u);
  all.subscription.reset();
  parts.subscription.reset();
  EXPECT_FALSE(link.message_log.enabled()) << "closed subscriptions cost nothing";
}

TEST(Subscription, SendsChangesOfMatchingValues) {
  const engine::test::SceneFile file(kWatchedScene);
  Show show(file.path());
  Subscriber changes(show.link, RequestKind::changes, "//{wind,gravity,mass}");
  const auto after = [&] {
    changes.new_lines();  // requests a snapshot
    wait_for_snapshot(show);
    return changes.texts();
  };
  EXPECT_EQ(after(), Texts{}) << "initial values are not changes";
  EXPECT_EQ(after(), Texts{}) << "poses are not settings";
  show.send("/scene/wind", 4.5);
  show.send("/physics/sim/gravity", 0, 0, -1);
  EXPECT_EQ(after(), (Texts{"/physics/sim/gravity 0 0 -9.81 → 0 0 -1", "/scene/wind 2 → 4.5"}));
  EXPECT_EQ(after(), Texts{});
  // Added and removed objects are not reported as changes of others; a value changed in the same tick is reported.
  show.send("/more");
  show.send("/scene/wind", 5);
  EXPECT_EQ(after(), Texts{"/scene/wind 4.5 → 5"});
  show.send("/physics/body/two/part/p/mass", 3);
  EXPECT_EQ(after(), (Texts{"/physics/body/two/mass 1 → 3", "/physics/body/two/part/p/mass 1 → 3"}));
  show.send("/less");
  EXPECT_EQ(after(), Texts{});
}

TEST(Subscription, SendsValuesSetByControllers) {
  const engine::test::SceneFile file(kWatchedScene);
  Show show(file.path());
  show.send("/scene/wind", 3);
  show.ticks(1);
  show.send("/scene/wind", 4);
  show.ticks(1);
  show.send("/physics/sim/gravity", 0, 0, -9.81);  // unchanged
  show.ticks(1);
  Subscriber controllers(show.link, RequestKind::changes);
  std::vector<ConsoleLine> lines = controllers.new_lines();
  ASSERT_EQ(lines.size(), 1u) << "earlier changes by controllers; a gesture counts once";
  EXPECT_EQ(lines[0].text, "/scene/wind 2 → 4");
  EXPECT_EQ(lines[0].origin, "127.0.0.1:4000");
  EXPECT_EQ(controllers.texts(), Texts{});
  show.send("/scene/wind", 5);
  show.link.command_queue.push({{},
                                {CommandSource::console},
                                std::make_shared<const engine::EvaluationRequest>(engine::EvaluationRequest{
                                    engine::EvaluationRequest::Action::run, "sim.gravity = vec3()"})});
  show.send("/later");
  show.ticks(5);  // a timer sets the sun: no controller
  lines = controllers.new_lines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "/scene/wind 2 → 5") << "the gesture continues";
  EXPECT_EQ(lines[1].text, "/physics/sim/gravity 0 0 -9.81 → 0 0 0");
  EXPECT_EQ(lines[1].origin, "console");
}

TEST(Subscription, SendsTheControllerOfAChange) {
  const engine::test::SceneFile file(kWatchedScene);
  Show show(file.path());
  Subscriber scene(show.link, RequestKind::changes, "/scene/*");
  // a snapshot may be taken between the ticks, and another one after all changes
  const auto after = [&] {
    std::vector<ConsoleLine> all = scene.new_lines();
    wait_for_snapshot(show);
    for (ConsoleLine& line : scene.new_lines()) all.push_back(std::move(line));
    return all;
  };
  after();
  show.send("/scene/wind", 5);
  show.send("/later");
  show.ticks(5);
  const std::vector<ConsoleLine> lines = after();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "/scene/wind 2 → 5");
  EXPECT_EQ(lines[0].origin, "127.0.0.1:4000");
  EXPECT_EQ(lines[1].text, "/scene/sun 0 → 1");
  EXPECT_EQ(lines[1].origin, "") << "a timer is not a controller";
}

TEST(Subscription, SendsAllKindsOfMatchingValues) {
  const engine::test::SceneFile file(kWatchedScene);
  Show show(file.path());
  Subscriber falls(show.link, RequestKind::changes, "/physics/body/one/part/*/linear_velocity");
  falls.new_lines();
  wait_for_snapshot(show);
  EXPECT_EQ(falls.texts(), Texts{});
  wait_for_snapshot(show);
  const Texts texts = falls.texts();
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_TRUE(texts[0].starts_with("/physics/body/one/part/p/linear_velocity 0 0 -")) << texts[0];
  const auto wrong = make_subscription(show.link, {1, RequestKind::changes, "wind"});
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error(), "'wind' is not an address; it must begin with /");
}

}  // namespace
}  // namespace limber::console
