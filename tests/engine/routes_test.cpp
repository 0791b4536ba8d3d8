// Routes in a show: made by the scene and by messages; resets, reloads, presets, undo, takes and rewinds.
#include "engine/edited.h"
#include "engine/taken.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine::test {
namespace {

constexpr const char* kRouteShow = R"(
sim.gravity = vec3()
local ball = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("arm")
body:add_part("a", ball, { friction = 0.5 })
body:add_part("b", ball, { position = vec3(1, 0, 0) })
sim:add_route("slow", { from = { body:part("a"), "friction" }, to = { body:part("b"), "linear_damping" }, output = { 0, 0.5 } })
--MORE
)";

const std::string kA = "/physics/body/arm/part/a/";
const std::string kB = "/physics/body/arm/part/b/";

sim::Route* route_of(EditedShow& edited, const char* name = "slow") {
  return edited.world().behaviors().routes().find(name);
}

TEST(RoutesInShow, MessagesAddConnectAndRemove) {
  const SceneFile file(kRouteShow);
  Show show(file.path());
  show.send("/route/add", "shine", kA + "friction", kB + "transparency");
  show.ticks(1);
  EXPECT_EQ(show.read(kB + "transparency"), 0.5);
  EXPECT_EQ(show.read(kB + "linear_damping"), 0.25);
  show.send("/physics/route/shine/output_high", 0.5);
  show.send("/route/connect", "shine", kA + "friction", kB + "angular_damping");
  show.ticks(1);
  EXPECT_EQ(show.read(kB + "angular_damping"), 0.25) << "its settings stay";
  show.sent_texts();
  show.send("/list/routes");
  show.ticks(1);
  EXPECT_EQ(show.sent_texts(), std::vector<std::string>{"/list/routes slow shine"});
  show.send("/route/remove", "shine");
  show.ticks(1);
  EXPECT_FALSE(find_property(show.engine.store(), "/physics/route/shine").ok());
}

TEST(RoutesInShow, BadMessagesAreRejected) {
  const SceneFile file(kRouteShow);
  Show show(file.path());
  const auto reply = [&](const std::string& address, auto&&... args) {
    show.send(address, args...);
    show.ticks(1);
    const std::vector<std::string> texts = show.sent_texts();
    return texts.empty() ? "" : texts.front();
  };
  EXPECT_EQ(reply("/route/add", "x"),
            "/error /route/add takes a name and two addresses: the source and the target of the route");
  EXPECT_EQ(reply("/route/add", "x", "a", "/b"),
            "/error /route/add route 'x': from: 'a' is not an address: it must begin with /");
  EXPECT_EQ(reply("/route/add", "slow", "/a", "/b"),
            "/error /route/add there is a route 'slow' already; names are unique");
  EXPECT_EQ(reply("/route/connect", "slow", "/a", "b"),
            "/error /route/connect route 'slow': to: 'b' is not an address: it must begin with /");
  EXPECT_EQ(reply("/route/remove", "slwo"), "/error /route/remove there is no route 'slwo'; did you mean 'slow'?");
  EXPECT_EQ(show.read(kB + "linear_damping"), 0.25) << "the route that was to be connected to b is as before";
}

TEST(RoutesInShow, RoutesOfControllersSurviveResetsAndReloads) {
  EditedShow edited(kRouteShow);
  edited.show().send("/route/add", "shine", kA + "friction", kB + "transparency");
  edited.show().send("/physics/route/shine/output_high", 0.5);
  edited.show().send("/route/remove", "slow");
  edited.show().ticks(1);
  edited.show().send("/transport/reset");
  edited.show().ticks(2);
  ASSERT_NE(route_of(edited, "shine"), nullptr);
  EXPECT_EQ(edited.show().read("/physics/route/shine/output_high"), 0.5);
  EXPECT_EQ(edited.show().read(kB + "transparency"), 0.25);
  EXPECT_EQ(route_of(edited), nullptr) << "removed by the controller";
  EXPECT_EQ(edited.edit("--MORE", "body:add_part(\"c\", ball, { position = vec3(3, 0, 0) })"),
            SceneReloader::ApplyResult::applied);
  edited.show().send(kA + "friction", 0.25);
  edited.show().ticks(2);
  ASSERT_NE(route_of(edited, "shine"), nullptr);
  EXPECT_EQ(edited.show().read(kB + "transparency"), 0.125) << "connected to the rebuilt body";
}

TEST(RoutesInShow, AReloadAppliesChanges) {
  EditedShow edited(kRouteShow);
  edited.show().ticks(2);
  const NodeId id = route_of(edited)->id();
  EXPECT_EQ(edited.edit("{ 0, 0.5 }", "{ 0, 0.25 }"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(route_of(edited)->id(), id);
  EXPECT_EQ(edited.show().read("/physics/route/slow/output_high"), 0.25);
  EXPECT_EQ(edited.edit("\"linear_damping\"", "\"angular_damping\""), SceneReloader::ApplyResult::applied);
  edited.show().ticks(1);
  EXPECT_EQ(edited.show().read(kB + "angular_damping"), 0.125);
  EXPECT_EQ(edited.edit("--MORE",
                        "sim:add_route(\"more\", { from = \"/physics/sim/time\", to = \"" + kB + "transparency\" })"),
            SceneReloader::ApplyResult::applied);
  EXPECT_NE(route_of(edited, "more"), nullptr);
  EXPECT_EQ(edited.edit("sim:add_route(\"slow\"", "--"), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(route_of(edited), nullptr);
  edited.show().ticks(2);
}

TEST(RoutesInShow, PresetsAndUndoContainTheirSettings) {
  const SceneFile file(kRouteShow);
  Show show(file.path());
  show.send("/preset/store", "before");
  show.ticks(1);
  show.send("/physics/route/slow/output_high", 1);
  show.ticks(1);
  EXPECT_EQ(show.read(kB + "linear_damping"), 0.5);
  show.send("/edit/undo");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/route/slow/output_high"), 0.5);
  show.send("/physics/route/slow/enabled", 0);
  show.ticks(1);
  show.send("/preset/recall", "before");
  show.ticks(1);
  EXPECT_EQ(show.read("/physics/route/slow/enabled"), 1);
}

TEST(RoutesInShow, PresetsContainTheRoutes) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kRouteShow);
  const std::string scene = folder.path("scripts/scene.lua");
  {
    Show show(scene);
    show.send("/route/add", "shine", kA + "friction", kB + "transparency");
    show.send("/physics/route/shine/output_high", 0.5);
    show.send("/preset/store", "lit");
    show.send("/preset/store", "dark", "/physics/body//*");
    show.ticks(1);
    show.engine.finish_saving();
  }
  Show show(scene);
  show.ticks(1);
  EXPECT_FALSE(find_property(show.engine.store(), "/physics/route/shine").ok()) << "it ended with the program";
  show.send("/preset/recall", "dark");
  show.ticks(1);
  EXPECT_FALSE(find_property(show.engine.store(), "/physics/route/shine").ok()) << "not selected";
  show.send("/preset/recall", "lit");
  show.ticks(2);
  EXPECT_EQ(show.read("/physics/route/shine/output_high"), 0.5);
  EXPECT_EQ(show.read(kB + "transparency"), 0.25);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read(kB + "transparency"), 0.25) << "a reset recalls it again";
}

TEST(RoutesInShow, TakesReplayThem) {
  const ShowFolder folder;
  folder.write("scripts/scene.lua", kRouteShow);
  EngineOptions options = fast_options(folder.path("scripts/scene.lua"));
  options.record = folder.path("routes.take");
  std::uint64_t hash = 0;
  {
    Show show(options);
    show.send("/route/add", "late", "/physics/sim/time", kB + "transparency");
    show.send("/physics/route/late/lag", 0.05);
    show.send("/physics/route/late/smoothing", 0.1);
    show.ticks(20);
    show.send("/route/remove", "slow");
    show.ticks(20);
    EXPECT_GT(show.read(kB + "transparency"), 0.3);
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
  }
  expect_replay(options.record, hash);
}

TEST(RoutesInShow, LuaReportsBadRoutes) {
  const auto error_of = [](const std::string& line) {
    log_to_stderr(false);
    EngineLink link;
    SceneFile file(std::string(kRouteShow) + line);
    Engine engine(link, fast_options(file.path()));
    const Result<void> started = engine.start();
    log_to_stderr(true);
    return started ? std::string() : started.error();
  };
  const auto expect_error = [&](const std::string& line, const std::string& text) {
    const std::string error = error_of(line);
    EXPECT_NE(error.find(text), std::string::npos) << line << "\n" << error;
  };
  expect_error("sim:add_route('x', { to = '/b' })", "add_route: from is an address, or { object, \"property\" }");
  expect_error("sim:add_route('x', { from = '/a', to = { body } })", "add_route: to: the property takes text");
  expect_error("sim:add_route('x', { from = '/a', to = '/b', input = 3 })",
               "add_route: input is two numbers { low, high }, not 3");
  expect_error("sim:add_route('x', { from = '/a', to = '/b', smothing = 3 })", "did you mean 'smoothing'");
  expect_error("sim:add_route('slow', { from = '/a', to = '/b' })", "there is a route 'slow' already");
  EXPECT_EQ(error_of("sim:add_route('x', { from = '/a', to = '/b' })"), "") << "it waits";
}

}  // namespace
}  // namespace limber::engine::test
