// Reload under fire: a hundred saves of good and broken versions from a thread of their own, while messages come in.
#include <thread>

#include "base/random.h"
#include "engine/edited.h"

namespace limber::engine_test {
namespace {

// `stone` and `arm` are the same in every good version; all else comes, goes and changes
std::string version(int number, Random& random) {
  std::string text = R"(
sim.gravity = vec3(0, 0, -9.81)
local ball = sim:add_sphere_shape("ball", 0.05)
local stone = sim:add_body("stone")
stone:add_part("p", ball, { position = vec3(0, 9, 3), linear_velocity = vec3(0.1, 0, 0) })
local arm = sim:add_body("arm")
arm:add_part("base", ball, { mass = 0, position = vec3(0, 0, 1) })
arm:add_part("tip", ball, { position = vec3(0.5, 0, 1) })
arm:add_joint("j", "base", "tip", { position = vec3(0, 0, 1), axis = vec3(0, 1, 0) })
arm:add_motor("j", { mode = "off" })
params { { "wind", 0, min = 0, max = 1e9 } }
state.count = state.count or 0
)";
  for (int i = 0, n = static_cast<int>(random.uniform(0, 6)); i < n; i++) {
    text +=
        fmt::format("local x{0} = sim:add_body('x{0}') x{0}:add_part('p', ball, {{ position = vec3({1}, 5, 2) }})\n", i,
                    random.uniform(-3, 3));
  }
  text += fmt::format("local version = {}\n", number);
  text += R"(
osc:on("/hit", function(n) state.count = state.count + 1 osc:send("/heard", n, state.count, params.wind, version) end)
sim:on_step(function() if #sim.bodies < 2 then error("bodies are missing") end end)
)";
  return text;
}

std::string broken(std::string good, Random& random) {
  constexpr const char* kEnds[] = {"\nerror('on purpose')", "\nsim.gravty = 1", "\nif", "\nlocal a = {} .. {}"};
  // half written; a half may be a whole scene by chance, but not with such an end
  if (random.uniform() < 0.4) return good.substr(0, static_cast<std::size_t>(random.uniform(80, 900))) + "\nend end";
  return good + kEnds[static_cast<std::size_t>(random.uniform(0, 4))];
}

struct Heard {
  int hits = 0;
  int errors = 0;
  int wind = 0;
  std::vector<int> versions;
};

void check_hit(const Message& m, Heard& heard) {
  ASSERT_EQ(m.args.size(), 4u);
  EXPECT_EQ(m.args[0].number, heard.hits) << "each message once: no handler twice, none lost";
  EXPECT_EQ(m.args[1].number, heard.hits + 1) << "state goes on";
  // handlers hear a message after all of its tick took effect
  EXPECT_GE(m.args[2].number, std::max(heard.hits, heard.wind)) << "the hand's parameter stays";
  heard.wind = static_cast<int>(m.args[2].number);
  heard.hits++;
  const int version = static_cast<int>(m.args[3].number);
  if (heard.versions.empty() || heard.versions.back() != version) heard.versions.push_back(version);
}

TEST(ReloadUnderFire, AHundredSavesWhileMessagesComeIn) {
  Random random(7, "fire");
  Edited edited(version(0, random));
  Edited control(version(0, random));
  Engine& engine = edited.show().engine;
  EngineLink& link = edited.show().link;
  std::atomic<bool> saved{false};
  std::vector<int> good{0};
  std::thread sim([&] { engine.run(); });
  std::thread editor([&] {
    for (int i = 1; i <= 100; i++) {
      const std::string text = version(i, random);
      const bool is_good = random.uniform() < 0.5;
      edited.folder.write("scripts/scene.lua", is_good ? text : broken(text, random));
      if (is_good) good.push_back(i);
      engine.reload();
    }
    saved = true;
  });
  Heard heard;
  std::vector<Outgoing> out;
  int sent = 0;
  while (!saved.load() || heard.hits < sent) {
    if (!saved.load() && sent < heard.hits + 8) {
      link.inbox.push({{message("/scene/wind", sent), message("/hit", sent)}, {Hand::osc, 1, 2}});
      sent++;
    }
    link.outbox.drain(out);
    for (const Outgoing& o : out) {
      if (o.message.address == "/heard") check_hit(o.message, heard);
      if (o.message.address == "/script/error") heard.errors++;
    }
    std::this_thread::yield();
  }
  editor.join();
  engine.stop();
  sim.join();
  EXPECT_EQ(heard.errors, 101 - static_cast<int>(good.size()));
  // the versions that were heard are good ones, in order, and the last good one is in force
  EXPECT_TRUE(std::includes(good.begin(), good.end(), heard.versions.begin(), heard.versions.end()));
  edited.show().outbox();
  edited.show().send("/hit", heard.hits);
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().outbox().back().substr(0, 6), "/heard");
  // what every version says alike has gone its way to the bit
  const auto ticks = static_cast<int>(engine.world().tick());
  ASSERT_GT(ticks, 10);
  control.show().ticks(ticks);
  for (const auto& [body, part] : {std::pair("stone", "p"), std::pair("arm", "base"), std::pair("arm", "tip")})
    EXPECT_EQ(motion_of(edited.part(body, part)), motion_of(control.part(body, part))) << body;
}

TEST(ReloadUnderFire, ResetsInBetween) {
  Random random(11, "fire");
  Edited edited(version(0, random));
  Engine& engine = edited.show().engine;
  std::thread sim([&] { engine.run(); });
  std::atomic<bool> saved{false};
  std::thread editor([&] {
    for (int i = 1; i <= 40; i++) {
      edited.folder.write("scripts/scene.lua", version(i, random));
      engine.reload();
    }
    saved = true;
  });
  for (int resets = 0; !saved.load(); resets++) {
    if (resets < 200) edited.show().send("/transport/reset");
    std::this_thread::yield();
  }
  editor.join();
  engine.stop();
  sim.join();
  edited.show().outbox();
  edited.show().send("/hit", 0);
  edited.show().ticks(1);
  const std::vector<std::string> texts = edited.show().outbox();
  ASSERT_FALSE(texts.empty());
  EXPECT_EQ(texts.back(), "/heard 0 1 0 40");
}

}  // namespace
}  // namespace limber::engine_test
