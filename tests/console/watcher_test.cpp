// Watchers: messages of the link's traffic, and what two images differ in.
#include "console/watcher.h"

#include "engine/show.h"

namespace limber {
namespace {

using engine_test::Show;
using Wish = ConsoleRequest::Wish;

constexpr const char* kWatchedScene = R"(
params { { "wind", 2, min = 0, max = 10 }, { "sun", 0 } }
local ball = sim:add_sphere_shape("ball", 0.1)
osc:on("/later", function() sim:after(0.02, function() params.sun = 1 end) end)
sim:add_body("one"):add_part("p", ball, { position = vec3(0, 0, 5) })
osc:on("/more", function() sim:body("one"):copy("two") end)
osc:on("/less", function() sim:body("two"):remove() end)
)";

struct Watching {
  explicit Watching(EngineLink& link, Wish wish, const std::string& pattern = "") {
    Result<std::unique_ptr<Watcher>> made = make_watcher(link, {1, wish, pattern});
    EXPECT_TRUE(made.ok());
    if (made) watcher = std::move(*made);
  }
  /// What is told now, as the protocol's lines.
  std::vector<ConsoleLine> told() {
    std::vector<ConsoleLine> lines;
    watcher->tell([&](const std::string& line) { lines.push_back(*parse_line(line.substr(0, line.size() - 1))); },
                  [&](std::uint64_t count) { missed += count; });
    return lines;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> all;
    for (const ConsoleLine& line : told()) all.push_back(line.text);
    return all;
  }
  std::unique_ptr<Watcher> watcher;
  std::uint64_t missed = 0;
};

using Texts = std::vector<std::string>;

// an image of a moment when all that was sent has been carried out
void make_image(Show& show) {
  const std::uint64_t ask = show.link.image_asks.load();
  for (int i = 0; i < 1000000; i++) {
    show.ticks(1);
    const auto made = show.link.images.read();
    if (made != nullptr && made->asks >= ask) return;
  }
  ADD_FAILURE() << "no image is made";
}

TEST(Watcher, TellsTrafficOfItsPattern) {
  EngineLink link;
  link.traffic.note(true, "a:1", {"/before", {}});
  Watching all(link, Wish::traffic);
  Watching parts(link, Wish::traffic, "/physics/*/mass");
  EXPECT_TRUE(link.traffic.watched());
  link.traffic.note(true, "a:1", {"/physics/part/mass", {Arg::of("arm"), Arg::of(0.3)}});
  link.traffic.note(false, "b:2", {"/pong", {}});
  const std::vector<ConsoleLine> told = all.told();
  ASSERT_EQ(told.size(), 2u) << "not what was before it watched";
  EXPECT_EQ(told[0].kind, ConsoleLine::Kind::in);
  EXPECT_EQ(told[0].text, "/physics/part/mass arm 0.3");
  EXPECT_EQ(told[0].end, "a:1");
  EXPECT_GT(told[0].time, 0);
  EXPECT_EQ(told[1].kind, ConsoleLine::Kind::out);
  EXPECT_TRUE(all.told().empty());
  EXPECT_EQ(parts.texts(), Texts{"/physics/part/mass arm 0.3"});
  for (std::size_t i = 0; i < Traffic::kMostLines + 7; i++) link.traffic.note(true, "", {"/flood", {}});
  EXPECT_EQ(all.told().size(), Traffic::kMostLines);
  EXPECT_EQ(all.missed, 7u);
  all.watcher.reset();
  parts.watcher.reset();
  EXPECT_FALSE(link.traffic.watched()) << "who has gone costs nothing";
}

TEST(Watcher, TellsChangesOfAPattern) {
  const engine_test::SceneFile file(kWatchedScene);
  Show show(file.path());
  Watching changes(show.link, Wish::changes, "//{wind,gravity,mass}");
  const auto after = [&] {
    changes.told();  // asks
    make_image(show);
    return changes.texts();
  };
  EXPECT_EQ(after(), Texts{}) << "what stands at the beginning has not changed";
  EXPECT_EQ(after(), Texts{}) << "a ball that falls is no property";
  show.send("/scene/wind", 4.5);
  show.send("/physics/sim/gravity", 0, 0, -1);
  EXPECT_EQ(after(), (Texts{"/physics/sim/gravity 0 0 -9.81 → 0 0 -1", "/scene/wind 2 → 4.5"}));
  EXPECT_EQ(after(), Texts{});
  // things that come and go are no change of the others'; what changes in the same moment is told
  show.send("/more");
  show.send("/scene/wind", 5);
  EXPECT_EQ(after(), Texts{"/scene/wind 4.5 → 5"});
  show.send("/physics/body/two/part/p/mass", 3);
  EXPECT_EQ(after(), Texts{"/physics/body/two/part/p/mass 1 → 3"});
  show.send("/less");
  EXPECT_EQ(after(), Texts{});
}

TEST(Watcher, TellsWhatHandsSet) {
  const engine_test::SceneFile file(kWatchedScene);
  Show show(file.path());
  show.send("/scene/wind", 3);
  show.ticks(1);
  show.send("/scene/wind", 4);
  show.ticks(1);
  show.send("/physics/sim/gravity", 0, 0, -9.81);  // as it is
  show.ticks(1);
  Watching hands(show.link, Wish::changes);
  std::vector<ConsoleLine> told = hands.told();
  ASSERT_EQ(told.size(), 1u) << "what hands have set before, a gesture as one";
  EXPECT_EQ(told[0].text, "/scene/wind 2 → 4");
  EXPECT_EQ(told[0].end, "127.0.0.1:4000");
  EXPECT_EQ(hands.texts(), Texts{});
  show.send("/scene/wind", 5);
  show.link.inbox.push(
      {{}, {Hand::console}, std::make_shared<const Evaluate>(Evaluate{Evaluate::Wish::run, "sim.gravity = vec3()"})});
  show.send("/later");
  show.ticks(5);  // a timer sets the sun: no hand
  told = hands.told();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].text, "/scene/wind 2 → 5") << "the gesture goes on";
  EXPECT_EQ(told[1].text, "/physics/sim/gravity 0 0 -9.81 → 0 0 0");
  EXPECT_EQ(told[1].end, "console");
}

TEST(Watcher, TellsOfAPatternWhoseHandItWas) {
  const engine_test::SceneFile file(kWatchedScene);
  Show show(file.path());
  Watching scene(show.link, Wish::changes, "/scene/*");
  // an image may have been made while ticks went on, and another one after all was done
  const auto after = [&] {
    std::vector<ConsoleLine> all = scene.told();
    make_image(show);
    for (ConsoleLine& line : scene.told()) all.push_back(std::move(line));
    return all;
  };
  after();
  show.send("/scene/wind", 5);
  show.send("/later");
  show.ticks(5);
  const std::vector<ConsoleLine> told = after();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].text, "/scene/wind 2 → 5");
  EXPECT_EQ(told[0].end, "127.0.0.1:4000");
  EXPECT_EQ(told[1].text, "/scene/sun 0 → 1");
  EXPECT_EQ(told[1].end, "") << "a timer is no hand";
}

TEST(Watcher, TellsAnyKindWhereAPatternSaysSo) {
  const engine_test::SceneFile file(kWatchedScene);
  Show show(file.path());
  Watching falls(show.link, Wish::changes, "/physics/body/one/part/*/linear_velocity");
  falls.told();
  make_image(show);
  EXPECT_EQ(falls.texts(), Texts{});
  make_image(show);
  const Texts texts = falls.texts();
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_TRUE(texts[0].starts_with("/physics/body/one/part/p/linear_velocity 0 0 -")) << texts[0];
  const auto wrong = make_watcher(show.link, {1, Wish::changes, "wind"});
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error(), "'wind' is no address: it must begin with /");
}

}  // namespace
}  // namespace limber
