// Motion capture in scripts: lists, handles, errors that name the argument, rollback.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/mocap/mocap_list.h"
#include "stage.h"

namespace limber::script {
namespace {

std::string mocap_value_of(const std::string& lines, const std::string& expression) {
  ScriptFixture fixture;
  const std::string fault = fixture.run(lines + "\nprint(" + expression + ")");
  return fault.empty() ? fixture.host.printed.back() : first_line(fault);
}

TEST(MocapScripts, PosiStageNetOpensItsGroupBesideThePorts) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run("sim:add_mocap('a', { source = 'psn' })"), "");
  const ListenAddress group{"236.10.10.10", 56565, true};
  EXPECT_EQ(fixture.host.plan.trackers, std::vector<ListenAddress>{group});
  EXPECT_TRUE(fixture.host.plan.listen.empty());
  const sim::MocapAxes axes = fixture.world.sensing().mocap().find("a")->setup()->axes;
  EXPECT_EQ(axes, (sim::MocapAxes{sim::MocapAxes::Up::y, true, 1}));
  ScriptFixture other;
  ASSERT_EQ(other.run("sim:add_mocap('a', { source = 'psn:10.0.0.2:5000', up = 'z', handed = 'right' })"), "");
  const ListenAddress address{"10.0.0.2", 5000, true};
  EXPECT_EQ(other.host.plan.trackers, std::vector<ListenAddress>{address});
  EXPECT_EQ(other.world.sensing().mocap().find("a")->setup()->axes, sim::MocapAxes{});
}

TEST(MocapScripts, HaveListsJointsAndSettings) {
  EXPECT_EQ(mocap_value_of("local a = sim:add_mocap('a', { source = 'osc', joints = { 'hips' }, fade = 2 })\n"
                           "local b = sim:add_mocap('b', { source = 'vmc' })\n"
                           "b.offset = vec3(1, 2, 3)",
                           "a, a.fade, b.offset.y, #sim.mocaps, sim.mocaps[2] == b, sim:mocap('a') == a, b.number, "
                           "a.joints[1], #b.joints"),
            "mocap 'a'\t2\t2\t2\ttrue\ttrue\t2\tmocap_joint 'a/hips'\t0");
  EXPECT_EQ(mocap_value_of("local a = sim:add_mocap('a', { source = 'osc', bones = { { 'hips', 'spine', 0.4 }, "
                           "{ 'spine', 'head' } } })\nlocal head = a:joint('head')",
                           "head.parent, head.parent.length, head.length, head.mocap == a, head.number, head.age"),
            "mocap_joint 'a/spine'\t0.4\t0.25\ttrue\t3\t-1");
}

TEST(MocapScripts, MakeABodyOfBones) {
  EXPECT_EQ(mocap_value_of("local a = sim:add_mocap('a', { source = 'osc', bones = { { 'hips', 'head', 0.4 } } })\n"
                           "local body = a:add_body('figure', { enabled = true })",
                           "#body.parts, body:part('head').motion, body:behavior('mocap').type, "
                           "#body:behavior('mocap').parts"),
            "2\tkinematic\tmocap_body\t2");
}

TEST(MocapScripts, ErrorsNameTheArgument) {
  const auto error_of = [](const char* options) {
    const std::string text = mocap_value_of("sim:add_mocap('a', " + std::string(options) + ")", "1");
    const std::string place = "scripts/scene.lua:1: ";
    EXPECT_TRUE(text.starts_with(place)) << text;
    return text.substr(std::min(place.size(), text.size()));
  };
  EXPECT_EQ(error_of("1"), "add_mocap takes a table such as { source = \"dancer.bvh\" }, not 1");
  EXPECT_EQ(error_of("{}"), "add_mocap: source (a .bvh file, 'osc', 'psn' or 'vmc') takes text, not nothing");
  EXPECT_EQ(error_of("{ source = 'osc', up = 'w' }").substr(0, 30), "mocap 'a': up has no value 'w'");
  EXPECT_EQ(error_of("{ source = 'osc', bones = { 1 } }"), "add_mocap: bone 1 is a list { parent, child }, not 1");
  EXPECT_EQ(error_of("{ source = 'osc', bones = { { 'a', 'b', -1 } } }"),
            "add_mocap: bone 1: the length is above 0 and at most 100 m, not -1");
  EXPECT_EQ(error_of("{ source = 'x.bvh', dancer = 1 }"),
            "add_mocap: a file has no messages and no dancer; remove one or the other");
  EXPECT_EQ(error_of("{ source = 'vmc', dancer = 1 }"), "add_mocap: VMC has no dancer; give each its own port");
  EXPECT_EQ(error_of("{ source = 'vmc', messages = { ['/a'] = 'x y z' } }"),
            "add_mocap: VMC has messages of its own; remove source or messages");
  EXPECT_EQ(error_of("{ source = 'psn', dancer = 1 }"),
            "add_mocap: PosiStageNet has no dancer; its trackers are the joints");
  for (const char* address : {"psn:", "psn:236.10.10.10", "psn:236.10.10:56565", "psn:236.10.10.10:0"})
    EXPECT_EQ(
        error_of(fmt::format("{{ source = '{}' }}", address).c_str()),
        fmt::format("mocap 'a': source '{}' must be psn or psn:ADDR:PORT, such as psn:236.10.10.10:56565", address));
  EXPECT_EQ(error_of("{ messages = { ['/a'] = 'x y z' }, dancer = 1 }"),
            "add_mocap: dancer has no effect on messages; remove it, and write it in their addresses");
  EXPECT_EQ(error_of("{ source = 'osc', joints = { 'a', 'a' } }"),
            "mocap 'a': there is a joint 'a' already; names are unique");
  EXPECT_EQ(error_of("{ source = 'osc', offfset = vec3() }"),
            "add_mocap: opts has no 'offfset'; did you mean 'offset'?");
}

TEST(MocapScripts, ABrokenFileIsReportedWithItsLine) {
  ScriptFixture fixture;
  fixture.write("scripts/film.bvh", "HIERARCHY\nROOT hips\n{\n  OFSET 0 0 0\n}\n");
  const std::string fault = first_line(fixture.run("sim:add_mocap('film', { source = 'film.bvh' })"));
  EXPECT_NE(fault.find("film.bvh, line 4: expected OFFSET, CHANNELS, JOINT, End Site or }, got 'OFSET'"),
            std::string::npos)
      << fault;
}

TEST(MocapScripts, AFailedRunLeavesNoSource) {
  ScriptFixture fixture;
  EXPECT_EQ(fixture.play("local a = sim:add_mocap('a', { source = 'osc' })\n"
                         "sim:on_step(function() a:joint('hand') error('stop') end)"),
            "");
  fixture.tick(1);
  EXPECT_TRUE(fixture.world.sensing().mocap().find("a")->joints().empty()) << "the call was rolled back";
}

}  // namespace
}  // namespace limber::script
