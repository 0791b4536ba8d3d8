// `limber monitor` and `limber send` with a running program.
#include <algorithm>
#include <tuple>

#include "app/playing.h"
#include "app/taken_port.h"

namespace limber::app::test {
namespace {

constexpr const char* kWatchedScene = R"(
params { { "wind", 2, min = 0, max = 10 } }
local ball = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", ball, { mass = 0 })
arm:add_part("tip", ball, { position = vec3(0, 0, -1) })
arm:add_joint("elbow", "base", "tip")
osc:on("/hello", function(name) osc:reply("/hello/back", name, 2) end)
osc:on("/all", function(...)
  local said = {}
  for i = 1, select("#", ...) do said[i] = ("%s:%s"):format(type((select(i, ...))), tostring((select(i, ...)))) end
  osc:reply("/all/back", table.concat(said, " "))
end)
)";

// on an OSC port chosen by the system, with its own folder for console sockets
struct WatchedShow {
  explicit WatchedShow(const std::string& out = "off")
      : running(limber_command({folder.file("scripts/scene.lua", kWatchedScene), "--osc-in", "127.0.0.1:0", "--osc-out",
                                out, "--query", "off"},
                               environment())) {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    in = running.text_after("OSC in ");
  }
  std::vector<std::string> environment() const {
    return {"env", "XDG_RUNTIME_DIR=" + runtime.path(), "TMPDIR=" + runtime.path()};
  }
  RunResult send(std::vector<std::string> words) const {
    words.insert(words.begin(), "send");
    if (std::ranges::find(words, "--wait") == words.end()) words.insert(words.end(), {"--wait", "60"});
    words.insert(words.end(), {"--to", in});
    return run(std::move(words));
  }
  std::vector<std::string> monitor(std::vector<std::string> words) const {
    words.insert(words.begin(), "monitor");
    return limber_command(std::move(words), environment());
  }
  TempFolder folder;
  console::PrivateFolder runtime;
  Process running;
  std::string in;
};

// every type of argument, negative numbers, and the reply
TEST(Send, TagsChooseTheTypesOfArguments) {
  const WatchedShow show;
  const RunResult all = show.send({"--tags", "ihfdTFNIsSc[ii]", "/all", "-7", "-1099511627776", "-1.5", "-0.1", "arm",
                                   "a b", "q", "-2147483648", "2147483647"});
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_EQ(all.out,
            "/all/back \"number:-7 number:-1099511627776 number:-1.5 number:-0.1 boolean:true boolean:false nil:nil "
            "boolean:true string:arm string:a b string:q number:-2147483648 number:2147483647\"\n");
  for (const auto& [tag, word, expected] : {std::tuple{"r", "ff8000ff", "a packed color (r)"},
                                            {"m", "00903c7f", "a MIDI message (m)"},
                                            {"t", "0000000000000001", "a time tag (t)"},
                                            {"b", "00ff", "a blob (b)"}}) {
    const RunResult rejected = show.send({"--tags", tag, "/all", word});
    EXPECT_EQ(rejected.code, 1) << tag;
    EXPECT_NE(rejected.err.find(expected), std::string::npos) << rejected.err;
  }
}

TEST(Send, RejectsArgumentsThatDoNotMatchTheirTags) {
  const auto rejected = [](std::vector<std::string> words, const std::string& text) {
    words.insert(words.begin(), {"send", "--to", "1", "--wait", "0", "--tags"});
    const RunResult result = run(std::move(words));
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
  };
  rejected({"if", "/a", "1"}, "--tags 'if' needs 2 arguments, got 1");
  rejected({"T", "/a", "1"}, "--tags 'T' needs 0 arguments, got 1");
  rejected({"i", "/a", "one"}, "'one' must be a number, since its tag is i");
  rejected({"c", "/a", "no"}, "'no' must be one ASCII character");
  rejected({"r", "/a", "ff80"}, "'ff80' must be 8 hexadecimal digits: red, green, blue, alpha");
  rejected({"b", "/a", "0"}, "'0' must be pairs of hexadecimal digits");
  rejected({"x", "/a", "0"}, "'x' is not an OSC type tag");
  rejected({"i]", "/a", "0"}, "a ']' without its '['");
  rejected({"[i", "/a", "0"}, "a '[' without its ']'");
}

TEST(Send, PrintsReplies) {
  const WatchedShow show;
  const RunResult set = show.send({"/scene/wind", "4.5"});
  EXPECT_EQ(set.code, 0) << set.err;
  EXPECT_EQ(set.out, "");
  EXPECT_EQ(show.send({"/get", "/scene/wind"}).out, "/scene/wind 4.5\n");
  EXPECT_EQ(show.send({"/physics/sim/gravity", "0", "0", "-3.5"}).code, 0) << "negative numbers are not options";
  EXPECT_EQ(show.send({"/get", "/physics/sim/gravity"}).out, "/physics/sim/gravity 0 0 -3.5\n");
  EXPECT_EQ(show.send({"/list/bodies"}).out, "/list/bodies arm\n");
  EXPECT_EQ(show.send({"/hello", "two words"}).out, "/hello/back \"two words\" 2\n");
  EXPECT_EQ(show.send({"/ping"}).out.substr(0, 6), "/pong ");
  // the value that the command itself queries to see the end of the replies
  for (const char* path : {"/physics/sim/tick", "/physics/sim/ti?k"}) {
    EXPECT_EQ(show.send({"/get", path}).out.substr(0, 18), "/physics/sim/tick ") << path;
  }
}

TEST(Send, ReportsErrors) {
  const WatchedShow show;
  const RunResult rejected = show.send({"/physics/part/mass", "arm", "tipp", "0.3"});
  EXPECT_EQ(rejected.code, 1);
  EXPECT_NE(rejected.err.find("did you mean 'tip'?"), std::string::npos) << rejected.err;
  EXPECT_EQ(show.send({"/scene/wimd", "1"}).code, 1);
  const RunResult no_address = run({"send", "scene/wind", "1"});
  EXPECT_EQ(no_address.code, 2);
  EXPECT_NE(no_address.err.find("must begin with /"), std::string::npos);
  EXPECT_EQ(run({"send", "/a", "--to", "127.0.0.1:70000"}).code, 2);
  const PortInUse silent(SOCK_DGRAM);  // never answers
  const RunResult nobody = run({"send", "/a", "--to", silent.port(), "--wait", "0.2"});
  EXPECT_EQ(nobody.code, 3);
  EXPECT_NE(nobody.err.find("no reply from " + silent.port()), std::string::npos) << nobody.err;
  EXPECT_EQ(run({"send", "/a", "--to", silent.port(), "--wait", "0"}).code, 0);
}

TEST(Monitor, PrintsMessagesInAndOut) {
  const WatchedShow show;
  Process monitor(show.monitor({"--count", "4"}));
  ASSERT_TRUE(monitor.wait_for("watching messages in"));
  EXPECT_EQ(show.send({"/scene/wind", "4.5"}).code, 0);
  EXPECT_EQ(show.send({"/physics/part/mass", "missing", "1", "--wait", "0"}).code, 0);
  const RunResult result = monitor.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("/scene/wind 4.5\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" < 127.0.0.1:"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" > 127.0.0.1:"), std::string::npos) << "the reply to send's own query: " << result.out;
}

TEST(Monitor, FiltersByPatternAndDirection) {
  const PortInUse sink(SOCK_DGRAM);
  const WatchedShow show("127.0.0.1:" + sink.port());
  Process streams(show.monitor({"/physics/joint/*", "--out", "--count", "3"}));
  const RunResult result = streams.finish();
  EXPECT_EQ(result.code, 0);
  for (const char* stream : {"/physics/joint/pos arm ", "/physics/joint/rot arm ", "/physics/joint/relrot arm "})
    EXPECT_NE(result.out.find(stream), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("> 127.0.0.1:" + sink.port() + " "), std::string::npos) << result.out;
  Process in(show.monitor({"--in", "--count", "1"}));
  ASSERT_TRUE(in.wait_for("watching messages in"));
  show.send({"/hello", "x", "--wait", "0"});
  EXPECT_NE(in.finish().out.find("/hello x\n"), std::string::npos);
}

TEST(Monitor, PrintsChanges) {
  const WatchedShow show;
  Process monitor(show.monitor({"--changes", "--count", "2"}));
  ASSERT_TRUE(monitor.wait_for("watching changes"));
  // changes are relative to the first snapshot: none is reported before
  double wind = 3;
  while (monitor.out().find("/scene/wind") == std::string::npos) {
    wind = wind >= 9 ? 3 : wind + 1;
    ASSERT_EQ(show.send({"/scene/wind", fmt::format("{}", wind)}).code, 0);
    monitor.read_available();
  }
  show.send({"/scene/wind", "0.5"});
  const RunResult result = monitor.finish();
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find(" = 127.0.0.1:"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" /scene/wind "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" → "), std::string::npos) << result.out;
}

TEST(Monitor, ReportsErrors) {
  const console::PrivateFolder empty;
  const RunResult nobody =
      Process(limber_command({"monitor"}, {"env", "XDG_RUNTIME_DIR=" + empty.path(), "TMPDIR=" + empty.path()}))
          .finish();
  EXPECT_EQ(nobody.code, 1);
  EXPECT_NE(nobody.err.find("limber: monitor: no Limber program of this user is running; start one"), std::string::npos)
      << nobody.err;
  const WatchedShow show;
  const RunResult wrong = Process(show.monitor({"wind"})).finish();
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.err.find("'wind' is not an address"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace limber::app::test
