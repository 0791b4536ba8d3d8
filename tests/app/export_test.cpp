// `limber export`: the poses in exported files are those of the engine that replays the take.
#include "app/commands/commands.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "app/program.h"
#include "engine/engine.h"
#include "export/loaded.h"
#include "support/world_objects.h"

namespace limber::app::test {
namespace {

using exporter::test::angle_between;
using exporter::test::Loaded;

// a swinging arm, a ball, and a body that exists from 0.5 s to 1 s; 80 ticks
constexpr const char* kShow = R"(
local box = sim:add_box_shape("box", vec3(0.1, 0.1, 0.4))
local ball = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("my arm")
local base = arm:add_part("base", box, { mass = 0, position = vec3(1, 2, 3), rotation = quat.axis(vec3(1, 0, 0), 0.5) })
local swing = arm:add_part("swing", box, { position = vec3(1, 2.3, 3.2) })
local tip = arm:add_part("tip", box, { position = vec3(1, 2.6, 3.4) })
arm:add_joint("shoulder", base, swing, { position = vec3(1, 2.1, 3), axis = vec3(1, 0, 0) })
arm:add_joint("wrist", swing, tip, { type = "spherical", position = vec3(1, 2.5, 3.3) })
sim:add_body("ball"):add_part("ball", ball, { position = vec3(5, 0, 9) })
sim:at(0.5, function() sim:add_body("guest"):add_part("ball", ball, { position = vec3(-4, 0, 2) }) end)
sim:at(1.0, function() sim:body("guest"):remove() end)
)";

std::string record(const TempFolder& folder, const std::string& scene, const std::string& ticks,
                   const std::string& name = "show") {
  std::string take = folder.path() + "/" + name + ".take";
  const RunResult result = run({folder.file(name + ".lua", scene), "--fast", "--ticks", ticks, "--record", take});
  EXPECT_EQ(result.code, 0) << result.err;
  return take;
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) all.push_back(entry.path().filename());
  std::sort(all.begin(), all.end());
  return all;
}

// poses of the parts after a number of ticks of the replay
std::map<std::string, Pose> poses_at(const std::string& take, std::uint64_t tick) {
  engine::EngineOptions options;
  options.replay = take;
  options.fast = true;
  engine::EngineLink link;
  engine::Engine engine(link, options);
  const Result<void> started = engine.start();
  EXPECT_TRUE(started) << started.error();
  while (engine.world().tick() < tick && !engine.replay_finished()) engine.tick();
  std::map<std::string, Pose> poses;
  for (const auto& body : engine.world().bodies()) {
    for (const auto& part : body->parts()) poses[body->name() + "." + part->name()] = part->pose();
  }
  return poses;
}

// columns by name; an empty cell becomes NaN
std::map<std::string, std::vector<double>> table_of(const std::string& file) {
  std::map<std::string, std::vector<double>> table;
  std::istringstream in(content(file));
  std::string line;
  std::string cell;
  std::getline(in, line);
  std::vector<std::string> names;
  for (std::istringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  while (std::getline(in, line)) {
    std::istringstream row(line + ",");
    for (const std::string& name : names) {
      std::getline(row, cell, ',');
      table[name].push_back(cell.empty() ? std::nan("") : std::stod(cell));
    }
  }
  return table;
}

TEST(Export, EachFormatHasThePosesOfTheEngine) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "80");
  for (const char* format : {"csv", "bvh", "gltf"}) {
    const RunResult result = run({"export", take, "--format", format});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("81 frames of 3 bodies, 60 a second\n"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("replayed 80 ticks: all hashes match the take\n"), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(files_in(folder.path()),
            (std::vector<std::string>{"show.csv", "show.glb", "show.lua", "show.take", "show_bvh"}));
  EXPECT_EQ(files_in(folder.path() + "/show_bvh"), (std::vector<std::string>{"ball.bvh", "guest.bvh", "my arm.bvh"}));
  const Loaded gltf(folder.path() + "/show.glb");
  const Loaded bvh(folder.path() + "/show_bvh/my arm.bvh");
  const auto table = table_of(folder.path() + "/show.csv");
  EXPECT_EQ(Loaded::count(gltf.scene().mRootNode), 1u + 3 + 5) << "scene, bodies, parts";
  const std::vector<double>& guest = table.at("guest/part/ball/x");
  const auto first_frame = static_cast<unsigned>(
      std::find_if(guest.begin(), guest.end(), [](double x) { return !std::isnan(x); }) - guest.begin());
  EXPECT_EQ(first_frame, 31u) << "in the first tick after half a second";
  for (const unsigned tick : {0u, 41u, 80u}) {
    for (const auto& [name, pose] : poses_at(take, tick)) {
      const std::string body = name.substr(0, name.find('.'));
      const std::string part = name.substr(name.find('.') + 1);
      const unsigned first = body == "guest" ? first_frame : 0;  // index of its first keyframe
      const Pose in_gltf = gltf.z_up(name, tick - first);
      EXPECT_LT(glm::length(in_gltf.position - pose.position), 1e-4) << name << tick;
      EXPECT_LT(angle_between(in_gltf.rotation, pose.rotation), 2e-3) << name << tick;
      const auto column = [&](const char* value) {
        return table.at((body == "my arm" ? "my%20arm" : body) + "/part/" + part + "/" + value)[tick];
      };
      EXPECT_LT(glm::length(Vec3(column("x"), column("y"), column("z")) - pose.position), 1e-4) << name << tick;
      EXPECT_LT(angle_between(quat_xyzw(column("qx"), column("qy"), column("qz"), column("qw")), pose.rotation), 1e-3);
      if (body == "my arm") {
        EXPECT_LT(glm::length(bvh.z_up(part, tick).position - pose.position), 1e-4) << name << tick;
      }
    }
  }
  EXPECT_EQ(gltf.channel("my arm.base"), nullptr) << "a static part has no keyframes";
  ASSERT_NE(gltf.channel("my arm.swing"), nullptr);
  EXPECT_EQ(gltf.channel("my arm.swing")->mNumRotationKeys, 81u);
  EXPECT_EQ(gltf.channel("guest.ball")->mNumPositionKeys, 30u);
  EXPECT_EQ(gltf.channel("guest")->mNumScalingKeys, 3u) << "hidden, visible, hidden";
}

TEST(Export, ContainsJointAngles) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "80");
  ASSERT_EQ(run({"export", take, "--format", "csv"}).code, 0);
  auto table = table_of(folder.path() + "/show.csv");
  const auto rotation = [&](const std::string& part, std::size_t i) {
    const auto at = [&](const char* value) { return table.at("my%20arm/part/" + part + "/" + value)[i]; };
    return quat_xyzw(at("qx"), at("qy"), at("qz"), at("qw"));
  };
  double peak = 0;
  for (const std::size_t i : {10u, 40u, 80u}) {
    const double angle = table.at("my%20arm/joint/shoulder/angle")[i];
    peak = std::max(peak, std::abs(angle));
    EXPECT_LT(angle_between(rotation("base", i) * quat_axis({1, 0, 0}, angle) * glm::conjugate(rotation("base", 0)),
                            rotation("swing", i) * glm::conjugate(rotation("swing", 0))),
              5e-3);
  }
  EXPECT_GT(peak, 0.3) << "it swings";
  for (const char* value : {"angle_x", "angle_y", "angle_z"})
    EXPECT_EQ(table.count(std::string("my%20arm/joint/wrist/") + value), 1u) << value;
}

TEST(Export, InterpolatesBetweenTicks) {
  const TempFolder folder;
  const std::string take = record(folder, R"(
sim.gravity = vec3(0, 0, 0)
local ball = sim:add_body("ball"):add_part("p", sim:add_sphere_shape("ball", 0.1))
ball.linear_velocity = vec3(1.5, 0, 0)
ball.angular_velocity = vec3(0, 0, 2)
)",
                                  "60");
  for (const auto& [rate, frames] : {std::pair("37", 38u), {"24", 25u}, {"1000", 1001u}, {"0.5", 1u}}) {
    const std::string file = folder.path() + "/" + rate + ".csv";
    ASSERT_EQ(run({"export", take, "-o", file, "--rate", rate}).code, 0);
    const auto table = table_of(file);
    ASSERT_EQ(table.at("time").size(), frames) << rate;
    for (std::size_t i = 0; i < frames; i++) {
      const double time = static_cast<double>(i) / std::stod(rate);
      EXPECT_NEAR(table.at("time")[i], time, 1e-9);
      EXPECT_NEAR(table.at("ball/part/p/x")[i], 1.5 * time, 2e-5) << rate << " " << i;
      EXPECT_NEAR(table.at("ball/part/p/qz")[i], std::sin(time), 2e-5) << "half the angle; " << rate << " " << i;
      EXPECT_NEAR(table.at("ball/part/p/qw")[i], std::cos(time), 2e-5) << rate << " " << i;
    }
  }
  const std::string part = folder.path() + "/part.csv";
  ASSERT_EQ(run({"export", take, "-o", part, "--rate", "10", "--from", "0.25", "--to", "0.75"}).code, 0);
  const auto table = table_of(part);
  ASSERT_EQ(table.at("time").size(), 6u);
  EXPECT_NEAR(table.at("time").front(), 0.25, 1e-9);
  EXPECT_NEAR(table.at("ball/part/p/x").back(), 1.5 * 0.75, 2e-5);
}

// a ball that moves at 1 m/s, and a message from outside at mid-time
std::string record_ball(const TempFolder& folder, int before, const Message& message, int after) {
  std::string take = folder.path() + "/show.take";
  engine::EngineOptions options;
  options.scene = folder.file("show.lua", R"(
sim.gravity = vec3(0, 0, 0)
sim:add_body("ball"):add_part("p", sim:add_sphere_shape("ball", 0.1)).linear_velocity = vec3(1, 0, 0)
)");
  options.record = take;
  options.fast = true;
  engine::EngineLink link;
  engine::Engine engine(link, options);
  EXPECT_TRUE(engine.start());
  for (int i = 0; i < before; i++) engine.tick();
  link.command_queue.push({{message}, {CommandSource::osc, 0x7f000001, 4000}});
  for (int i = 0; i < after; i++) engine.tick();
  engine.end_take();
  return take;
}

TEST(Export, ContinuesAfterAReset) {
  const TempFolder folder;
  const std::string take = record_ball(folder, 30, {"/transport/reset", {}}, 20);
  const RunResult result = run({"export", take, "--format", "csv", "--rate", "40"});
  EXPECT_EQ(result.code, 0) << result.err;
  const auto table = table_of(folder.path() + "/show.csv");
  EXPECT_EQ(table.size(), 8u) << "one body";
  const std::vector<double>& x = table.at("ball/part/p/x");
  double peak = 0;
  for (std::size_t i = 0; i < x.size(); i++) {
    EXPECT_NEAR(table.at("time")[i], static_cast<double>(i) / 40, 1e-9);
    peak = std::max(peak, x[i]);
    if (i == 0) continue;
    const bool continues = std::abs(x[i] - x[i - 1] - 1.0 / 40) < 1e-4;
    EXPECT_TRUE(continues || x[i] < 0.026) << "no interpolation across the reset: " << x[i];
  }
  EXPECT_NEAR(peak, 0.5, 0.03);
}

TEST(Export, RewindTakesOneFrame) {
  const TempFolder folder;
  const std::string take = record_ball(folder, 90, {"/transport/rewind", {Arg::of(0.25)}}, 30);
  const RunResult result = run({"export", take, "--format", "csv", "--rate", "60"});
  EXPECT_EQ(result.code, 0) << result.err;
  const auto table = table_of(folder.path() + "/show.csv");
  const std::vector<double>& x = table.at("ball/part/p/x");
  ASSERT_EQ(x.size(), 121U) << "the start, and each tick that was played";
  EXPECT_NEAR(x[90], 1.5, 1e-3);
  EXPECT_NEAR(x[91], 1.25 + 1.0 / 60, 1e-3);
  EXPECT_NEAR(x[120], 1.75, 1e-3);
}

TEST(Export, SelectsBodies) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "40");
  const std::string one = folder.path() + "/one.bvh";
  EXPECT_EQ(run({"export", take, "-o", one, "--body", "my arm"}).code, 0);
  EXPECT_EQ(Loaded(one).scene().mRootNode->FindNode("tip") != nullptr, true);
  const std::string two = folder.path() + "/two.csv";
  EXPECT_EQ(run({"export", take, "-o", two, "--body", "b*", "--body", "guest"}).code, 0);
  EXPECT_EQ(table_of(two).size(), 15u);
  const RunResult none = run({"export", take, "-o", folder.path() + "/none.csv", "--body", "bal"});
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.err.find("no body 'bal' in the take; did you mean 'ball'?"), std::string::npos) << none.err;
  const RunResult many = run({"export", take, "-o", folder.path() + "/many.bvh"});
  EXPECT_NE(many.err.find("Choose one with --body"), std::string::npos) << many.err;
  EXPECT_NE(many.code, 0);
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"one.bvh", "show.lua", "show.take", "two.csv"}));
}

TEST(Export, DoesNotOverwriteByDefault) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "5");
  const std::string bin = folder.file("a.bin", "mine");
  const std::string csv = folder.file("a.csv", "mine");
  folder.file("a_bvh/note", "mine");
  for (const auto& [output, message] : {std::pair("a.csv", "overwrite it with --overwrite"),
                                        {"a.gltf", "a.bin already exists"},
                                        {"a_bvh", "which is never overwritten"}}) {
    const RunResult result =
        run({"export", take, "--format", std::string(output).substr(2), "-o", folder.path() + "/" + output});
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  }
  EXPECT_EQ(content(bin) + content(csv) + content(folder.path() + "/a_bvh/note"), "mineminemine");
  EXPECT_EQ(run({"export", take, "-o", csv, "--overwrite"}).code, 0);
  EXPECT_TRUE(content(csv).starts_with("time,"));
}

TEST(Export, CancellationLeavesNoFile) {
  const TempFolder folder;
  ExportCommand command;
  command.take = record(folder, kShow, "40");
  for (const char* name : {"a.csv", "a.glb", "a.gltf", "a_bvh"}) {
    command.output = folder.path() + "/" + name;
    command.format = std::string(name) == "a_bvh" ? "bvh" : "";
    int asked = 0;
    EXPECT_EQ(export_take(command, [&] { return ++asked > 20; }), 1);
    EXPECT_EQ(asked, 21);
    EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"show.lua", "show.take"})) << name;
  }
}

TEST(Export, FullDiskIsExitCode3) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "80");
  const std::string command =
      fmt::format("ulimit -f 8; exec {} export {} --format csv --rate 1000", LIMBER_PROGRAM, take);
  const RunResult result = Process({"/bin/sh", "-c", command}).finish();
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_NE(result.err.find("show.csv can't be written: File too large"), std::string::npos) << result.err;
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"show.lua", "show.take"}));
}

TEST(Export, ExportsATruncatedTakeToItsLastTick) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "80");
  const std::string cut = folder.file("cut.take", content(take).substr(0, content(take).size() - 200));
  const RunResult result = run({"export", cut, "--format", "csv"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("the take was cut off there"), std::string::npos) << result.err;
  const std::size_t frames = table_of(folder.path() + "/cut.csv").at("time").size();
  EXPECT_GT(frames, 10u);
  EXPECT_LT(frames, 81u);
  EXPECT_NE(result.err.find(fmt::format("replayed {} ticks", frames - 1)), std::string::npos) << result.err;
}

TEST(Export, EmptySceneGivesAnEmptyFile) {
  const TempFolder folder;
  const std::string take = record(folder, "", "3");
  EXPECT_EQ(run({"export", take, "--format", "csv", "--rate", "20"}).code, 0);
  EXPECT_EQ(content(folder.path() + "/show.csv"), "time\n0\n0.05\n");
  EXPECT_EQ(run({"export", take, "--format", "gltf"}).code, 0);
  const RunResult bvh = run({"export", take, "--format", "bvh"});
  EXPECT_NE(bvh.code, 0);
  EXPECT_NE(bvh.err.find("there is no body to write"), std::string::npos) << bvh.err;
}

TEST(Export, ErrorsNameTheFix) {
  const TempFolder folder;
  const std::string take = record(folder, kShow, "5");
  struct Case {
    std::vector<std::string> args;
    int code;
    const char* message;
  };
  const Case cases[] = {
      {{"/nowhere.take", "--format", "csv"}, 1, "/nowhere.take"},
      {{folder.path() + "/show.lua", "--format", "csv"}, 1, "show.lua"},
      {{take, "-o", "/nowhere/a.csv"}, 1, "/nowhere/a.csv can't be written"},
  };
  for (const Case& c : cases) {
    std::vector<std::string> args = {"export"};
    args.insert(args.end(), c.args.begin(), c.args.end());
    const RunResult result = run(args);
    EXPECT_EQ(result.code, c.code) << result.err;
    EXPECT_NE(result.err.find(c.message), std::string::npos) << result.err;
  }
  const std::string help = run({"export", "--help"}).out;
  for (const char* taught :
       {"--rate", "--body", "--from", "--overwrite", "Y up", "docs/howto/export.md", "evening.glb"})
    EXPECT_NE(help.find(taught), std::string::npos) << taught;
}

// A ball that rests on the floor, and one that falls: v = −g·t after t, N = m·g.
TEST(Export, ExtrasAreVelocitiesTorquesAndContacts) {
  const TempFolder folder;
  const std::string take = record(folder, R"(
sim:add_body("ground"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_sphere_shape("ball", 0.1)
sim:add_body("rests"):add_part("ball", ball, { mass = 2, position = vec3(0, 0, 0.1), report_contacts = true })
sim:add_body("falls"):add_part("ball", ball, { position = vec3(9, 0, 99) })
)",
                                  "60");
  const std::string table = folder.path() + "/t.csv";
  const RunResult result =
      run({"export", take, "-o", table, "--with", "velocities,contacts", "--with", "torques", "--from", "1"});
  ASSERT_EQ(result.code, 0) << result.err;
  std::istringstream lines(content(table));
  std::string header;
  std::string line;
  std::getline(lines, header);
  std::getline(lines, line);
  std::map<std::string, double> values;
  std::istringstream names(header);
  std::istringstream cells(line);
  for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');)
    values[name] = cell.empty() ? 0 : std::stod(cell);
  ASSERT_TRUE(values.contains("falls/part/ball/linear_velocity_z")) << header;
  EXPECT_NEAR(values["falls/part/ball/linear_velocity_z"], -9.81, 1e-3);
  EXPECT_NEAR(values["rests/part/ball/linear_velocity_z"], 0, 1e-3);
  EXPECT_NEAR(values["rests/part/ball/contact_normal_force"], 2 * 9.81, 0.05);
  EXPECT_NEAR(values["rests/part/ball/contact_force_z"], 2 * 9.81, 0.05);
  EXPECT_EQ(values["falls/part/ball/contact_normal_force"], 0);
  const RunResult wrong = run({"export", take, "-o", folder.path() + "/t.glb", "--with", "torques"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("--with adds columns to a table"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace limber::app::test
