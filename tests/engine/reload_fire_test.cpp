// Reload under load: a hundred saves of good and broken versions from another thread, while messages arrive.
#include <thread>

#include "base/random.h"
#include "engine/edited.h"

namespace limber::engine::test {
namespace {

// `stone` and `arm` are the same in every good version; everything else is added, removed and changed
std::string version_text(int number, Random& random) {
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

std::string broken_version(std::string good, Random& random) {
  constexpr const char* kEnds[] = {"\nerror('on purpose')", "\nsim.gravty = 1", "\nif", "\nlocal a = {} .. {}"};
  // half written; a half may be a valid scene by chance, but not with this end
  if (random.uniform() < 0.4) return good.substr(0, static_cast<std::size_t>(random.uniform(80, 900))) + "\nend end";
  return good + kEnds[static_cast<std::size_t>(random.uniform(0, 4))];
}

struct ReceivedMessages {
  int hits = 0;
  int errors = 0;
  int wind = 0;
  std::vector<int> versions;
};

void check_hit(const Message& m, ReceivedMessages& received) {
  ASSERT_EQ(m.args.size(), 4u);
  EXPECT_EQ(m.args[0].number, received.hits) << "each message once: no handler twice, none lost";
  EXPECT_EQ(m.args[1].number, received.hits + 1) << "state persists";
  // handlers are called after all messages of the tick have taken effect
  EXPECT_GE(m.args[2].number, std::max(received.hits, received.wind)) << "the overridden parameter stays";
  received.wind = static_cast<int>(m.args[2].number);
  received.hits++;
  const int version = static_cast<int>(m.args[3].number);
  if (received.versions.empty() || received.versions.back() != version) received.versions.push_back(version);
}

TEST(ReloadUnderLoad, SurvivesAHundredSavesWhileMessagesArrive) {
  Random random(7, "fire");
  EditedShow edited(version_text(0, random));
  EditedShow control(version_text(0, random));
  Engine& engine = edited.show().engine;
  EngineLink& link = edited.show().link;
  std::atomic<bool> saved{false};
  std::vector<int> good{0};
  std::thread sim([&] { engine.run(); });
  std::thread editor([&] {
    for (int i = 1; i <= 100; i++) {
      const std::string text = version_text(i, random);
      const bool is_good = random.uniform() < 0.5;
      edited.folder.write("scripts/scene.lua", is_good ? text : broken_version(text, random));
      if (is_good) good.push_back(i);
      engine.reload();
    }
    saved = true;
  });
  ReceivedMessages received;
  std::vector<Outgoing> out;
  int sent = 0;
  while (!saved.load() || received.hits < sent) {
    if (!saved.load() && sent < received.hits + 8) {
      link.command_queue.push({{message("/scene/wind", sent), message("/hit", sent)}, {CommandSource::osc, 1, 2}});
      sent++;
    }
    link.output_queue.drain(out);
    for (const Outgoing& o : out) {
      if (o.message.address == "/heard") check_hit(o.message, received);
      if (o.message.address == "/script/error") received.errors++;
    }
    std::this_thread::yield();
  }
  editor.join();
  engine.stop();
  sim.join();
  EXPECT_EQ(received.errors, 101 - static_cast<int>(good.size()));
  // the versions that were played are good ones, in order, and the last good one plays now
  EXPECT_TRUE(std::includes(good.begin(), good.end(), received.versions.begin(), received.versions.end()));
  edited.show().sent_texts();
  edited.show().send("/hit", received.hits);
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().sent_texts().back().substr(0, 6), "/heard");
  // objects that are equal in all versions have moved undisturbed, to the bit
  const auto ticks = static_cast<int>(engine.world().tick());
  ASSERT_GT(ticks, 10);
  control.show().ticks(ticks);
  for (const auto& [body, part] : {std::pair("stone", "p"), std::pair("arm", "base"), std::pair("arm", "tip")})
    EXPECT_EQ(motion_of(edited.part(body, part)), motion_of(control.part(body, part))) << body;
}

TEST(ReloadUnderLoad, SurvivesResetsDuringSaves) {
  Random random(11, "fire");
  EditedShow edited(version_text(0, random));
  Engine& engine = edited.show().engine;
  std::thread sim([&] { engine.run(); });
  std::atomic<bool> saved{false};
  std::thread editor([&] {
    for (int i = 1; i <= 40; i++) {
      edited.folder.write("scripts/scene.lua", version_text(i, random));
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
  edited.show().sent_texts();
  edited.show().send("/hit", 0);
  edited.show().ticks(1);
  const std::vector<std::string> texts = edited.show().sent_texts();
  ASSERT_FALSE(texts.empty());
  EXPECT_EQ(texts.back(), "/heard 0 1 0 40");
}

}  // namespace
}  // namespace limber::engine::test
