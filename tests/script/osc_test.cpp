// osc: handlers and patterns, outgoing messages, declared ports.
#include <gtest/gtest.h>

#include "stage.h"

namespace limber::script {
namespace {

using Lines = std::vector<std::string>;

std::string text_of(const Message& message) {
  std::string text = message.address;
  for (const Arg& arg : message.args) {
    text += arg.kind == Arg::Kind::text      ? " '" + arg.text + "'"
            : arg.kind == Arg::Kind::boolean ? (arg.number != 0 ? " true" : " false")
                                             : fmt::format(" {}", arg.number);
  }
  return text;
}

TEST(Osc, HandlersReceiveMatchingMessages) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local function say(name) return function(...) print(name, select("#", ...), ...) end end
osc:on("/a/b", say("exact"))
osc:on("/a/*", say("star"))
osc:on("/{a,x}/b", say("brace"))
osc:on("//b", say("deep"))
osc:on("/c", say("other"))
)"),
            "");
  EXPECT_TRUE(fixture.scene.has_handlers());
  EXPECT_TRUE(fixture.scene.handle_message({"/a/b", {Arg::of(1.5), Arg::of("x"), Arg::of(true), {}}}, {}));
  EXPECT_EQ(fixture.host.printed, (Lines{"exact\t4\t1.5\tx\ttrue\tnil", "star\t4\t1.5\tx\ttrue\tnil",
                                         "brace\t4\t1.5\tx\ttrue\tnil", "deep\t4\t1.5\tx\ttrue\tnil"}));
  fixture.host.printed.clear();
  EXPECT_TRUE(fixture.scene.handle_message({"/k/l/b", {}}, {}));
  EXPECT_EQ(fixture.host.printed, Lines{"deep\t0"});
  fixture.host.printed.clear();
  // the incoming address may be a pattern too
  EXPECT_TRUE(fixture.scene.handle_message({"/?", {Arg::of(2.0)}}, {}));
  EXPECT_EQ(fixture.host.printed, Lines{"other\t1\t2"});
  EXPECT_FALSE(fixture.scene.handle_message({"/unknown", {}}, {}));
  EXPECT_FALSE(fixture.scene.handle_message({"/a/b/c", {}}, {}));
}

TEST(Osc, HandlersHaveAddressSenderAndReply) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
print(osc.address, osc.sender)
osc:on("/ask", function(x) print(osc.address, osc.sender) osc:reply("/answer", x * 2) end)
)"),
            "");
  const CommandOrigin origin{CommandSource::osc, 0x0a000102u, 5000};
  EXPECT_TRUE(fixture.scene.handle_message({"/ask", {Arg::of(21.0)}}, origin));
  EXPECT_EQ(fixture.host.printed, (Lines{"nil\tnil", "/ask\t10.0.1.2:5000"}));
  ASSERT_EQ(fixture.host.replies.size(), 1u);
  EXPECT_EQ(fixture.host.replies[0].first.ip, origin.ip);
  EXPECT_EQ(fixture.host.replies[0].first.port, 5000);
  EXPECT_EQ(text_of(fixture.host.replies[0].second), "/answer 42");
  EXPECT_EQ(
      callback_error_of("", "osc:reply('/a')"),
      "scripts/scene.lua:1: osc:reply answers the message that is being handled: call it inside an osc:on function");
}

TEST(Osc, SendsNumbersTextBooleansAndVectors) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim:on_start(function()
  osc:send("/a", 1, "two", true, false, vec3(3, 4, 5), { 6, 7, 8 })
  osc:to("127.0.0.1:7000"):send("/b")
  osc:to("localhost:7001"):send("/c", 1)
end)
)"),
            "");
  ASSERT_EQ(fixture.host.sent.size(), 1u);
  EXPECT_EQ(text_of(fixture.host.sent[0]), "/a 1 'two' true false 3 4 5 6 7 8");
  ASSERT_EQ(fixture.host.direct.size(), 2u);
  EXPECT_EQ(fixture.host.direct[0].first.ip, 0x7f000001u);
  EXPECT_EQ(fixture.host.direct[0].first.port, 7000);
  EXPECT_EQ(text_of(fixture.host.direct[1].second), "/c 1");
}

TEST(Osc, SendsToIPv6) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
sim:on_start(function()
  local to = osc:to("[2001:db8::7]:7000")
  to:send("/a", tostring(to), tostring(osc:to("10.0.0.5:9000")))
end)
)"),
            "");
  ASSERT_EQ(fixture.host.direct.size(), 1u);
  const CommandOrigin& to = fixture.host.direct[0].first;
  EXPECT_EQ(to.ip, system::IpAddress(0x20010db8ULL << 32U, 7));
  EXPECT_EQ(to.port, 7000);
  EXPECT_EQ(text_of(fixture.host.direct[0].second), "/a '[2001:db8::7]:7000' '10.0.0.5:9000'");
}

TEST(Osc, AWrongMessageIsNotSentAtAll) {
  for (const char* bad :
       {"osc:send('/a', 1, print)", "osc:send('/a', 1, 0 / 0)", "osc:send('a', 1)", "osc:send('/a', nil)",
        "osc:send('/ä')", "osc:send(1)", "osc:to('127.0.0.1:1'):send('/a', {})"}) {
    ScriptFixture fixture;
    ASSERT_EQ(fixture.play(std::string("sim:on_start(function() ") + bad + " end)"), "");
    EXPECT_EQ(fixture.host.faults.size(), 1u) << bad;
    EXPECT_TRUE(fixture.host.sent.empty() && fixture.host.direct.empty()) << bad;
  }
}

TEST(Osc, ASceneDeclaresPortsAndStreams) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run(R"(
osc:listen(9100)
osc:listen(9101)
osc:stream_to("10.0.0.5:9005", { rate = 30, streams = "pos+relpos", bodies = "arm*", bundle = 1472, errors = true })
osc:stream_to("studio.local:9006", { streams = { "rot" }, bundle = "off" })
osc:stream_to("127.0.0.1:9007")
)"),
            "");
  EXPECT_EQ(fixture.host.plan_count, 1);
  EXPECT_EQ(fixture.host.plan.listen, (std::vector<ListenAddress>{{"127.0.0.1", 9100}, {"127.0.0.1", 9101}}));
  ASSERT_EQ(fixture.host.plan.targets.size(), 3u);
  EXPECT_EQ(fixture.host.plan.targets[0],
            (StreamTarget{"10.0.0.5", 9005, 30, true, false, false, true, "arm*", 1472, true}));
  EXPECT_EQ(fixture.host.plan.targets[1],
            (StreamTarget{"studio.local", 9006, 60, false, true, false, false, "*", 0, false}));
  EXPECT_EQ(fixture.host.plan.targets[2],
            (StreamTarget{"127.0.0.1", 9007, 60, true, true, true, false, "*", -1, false}));
}

TEST(Osc, AFailingRunConfiguresNothing) {
  ScriptFixture fixture;
  EXPECT_NE(fixture.run("osc:listen(9100) error('no')"), "");
  EXPECT_EQ(fixture.host.plan_count, 0);
}

TEST(Osc, ReportsMistakes) {
  const std::string at = "scripts/scene.lua:1: ";
  const std::pair<const char*, const char*> cases[] = {
      {"osc:on('a', print)", "osc:on: 'a' is not an address; it must begin with /"},
      {"osc:on('/a')", "osc:on takes a function, not nothing"},
      {"osc.on('/a', print)", "on is a method of osc: write osc:on(…), with a colon"},
      {"osc:sned('/a')", "osc has no member 'sned'; did you mean 'send'?"},
      {"osc.address = 1", "osc: 'address' can't be set"},
      {"osc:listen(70000)", "osc:listen takes a port 1 .. 65535, not 70000"},
      {"osc:stream_to('10.0.0.5')", "'10.0.0.5' is not an address; write \"host:port\", such as \"127.0.0.1:9000\""},
      {"osc:stream_to('a:1', { rate = 0 })", "osc:stream_to: rate is 0.1 .. 1000, not 0"},
      {"osc:stream_to('a:1', { streams = 'poss' })", "osc:stream_to: there is no stream 'poss'; did you mean 'pos'?"},
      {"osc:stream_to('a:1', { bundle = 99 })", "osc:stream_to: bundle is 'off', 1472, 8192 or 65504, not 99"},
      {"osc:stream_to('a:1', { bodie = 'x' })", "osc:stream_to: opts has no 'bodie'; did you mean 'bodies'?"},
      {"osc:stream_to('two words:9000')",
       "'two words:9000' is not an address; write \"host:port\", such as \"127.0.0.1:9000\""},
      {"osc:to('::1:9000')", "'::1:9000' is not an address; write \"host:port\", such as \"127.0.0.1:9000\""},
      {"osc:to('[::1]')", "'[::1]' is not an address; write \"host:port\", such as \"127.0.0.1:9000\""},
      {"osc:to('[fe80::1]:9')", "fe80::1 is valid on one network only; add its interface, such as [fe80::1%eth0]"},
      {"osc:to('[fe80::1%none0]:9')", "'fe80::1%none0' names a network interface that does not exist"},
      {"osc:to('studio:9000')", "'studio' is a host name, which scripts can't resolve; write a numeric address"},
      {"osc:to('1.2.3.400:9000')", "'1.2.3.400' is a host name, which scripts can't resolve; write a numeric address"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(error_of(text), at + expected) << text;
  EXPECT_EQ(callback_error_of("", "osc:listen(9000)"),
            at + "osc:listen declares something about the scene; write it at the top level");
}

TEST(Osc, AMessageWithTooManyArgumentsIsNotHandled) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play("osc:on('/a', function(...) print(select('#', ...)) end)"), "");
  EXPECT_TRUE(fixture.scene.handle_message({"/a", std::vector<Arg>(4000, Arg::of(1.0))}, {}));
  EXPECT_FALSE(fixture.scene.handle_message({"/a", std::vector<Arg>(60000, Arg::of(1.0))}, {}));
  EXPECT_TRUE(fixture.scene.handle_message({"/a", {Arg::of(1.0)}}, {}));
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"4000", "1"}));
  ASSERT_EQ(fixture.logged().size(), 1u);
  EXPECT_EQ(fixture.logged()[0], "/a: 60000 arguments are more than a script's handler can receive (4000)");
}

}  // namespace
}  // namespace limber::script
