// OSC, OSCQuery and the port of the remote panel: a change by one client reaches all others, once.
#include <netinet/in.h>
#include <sys/socket.h>

#include <nlohmann/json.hpp>

#include "app/program.h"
#include "app/taken_port.h"
#include "osc/osc_test_tools.h"
#include "oscquery/web_client.h"

namespace limber::app::test {
namespace {

using nlohmann::json;
using osc::test::Bytes;
using osc::test::one_float;
using oscquery::test::WebClient;

constexpr const char* kWindyScene = R"(
params { { "wind", 0, min = 0, max = 10 }, { "style", "calm", choices = { "calm", "wild" } } }
local shape = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("ball")
body:add_part("ball", shape, { mass = 0 })
osc:on("/more", function() body:copy("more") end)
osc:on("/less", function() sim:body("more"):remove() end)
)";

struct WebPlayer {
  TempFolder folder;
  Process running;
  system::Endpoint osc{0x7f000001, 0};
  std::uint16_t web = 0;

  explicit WebPlayer(const std::vector<std::string>& more = {}) : running(limber_command(words(more))) {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    osc.port = number_after("OSC in 127.0.0.1:");
    web = number_after("remote panel http://127.0.0.1:");
  }
  std::vector<std::string> words(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {folder.file("s.lua", kWindyScene), "--osc-in", "127.0.0.1:0", "--osc-out", "off"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::uint16_t number_after(const std::string& prefix) const {
    return static_cast<std::uint16_t>(std::atoi(running.text_after(prefix).c_str()));
  }
};

std::string text_message(std::string_view address, std::string_view word) {
  return Bytes().text(address).text(",s").text(word).str();
}

TEST(Query, AllowsAdditionalHostNames) {
  const WebPlayer player({"--query-name", "vm.example", "--query-name", "Stage.example"});
  ASSERT_NE(player.web, 0);
  for (const auto& [name, status] : {std::pair("vm.example", 200), std::pair("stage.example", 200),
                                     std::pair("other.example", 403), std::pair("vm.example.other", 403)}) {
    WebClient client(player.web);
    client.send("GET /scene/wind HTTP/1.1\r\nHost: " + std::string(name) + ":9003\r\nOrigin: http://" + name +
                ":9003\r\n\r\n");
    EXPECT_EQ(client.reply().status, status) << name;
  }
  WebClient client(player.web);
  client.send("GET /scene/wind HTTP/1.1\r\nHost: vm.example\r\nOrigin: http://other.example\r\n\r\n");
  EXPECT_EQ(client.reply().status, 403) << "a page of another site";
  const RunResult result = run({"play", "--query-name", "http://vm.example"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("write it without http:// and port"), std::string::npos) << result.err;
}

TEST(Query, ChangeReachesAllOtherClientsOnce) {
  const WebPlayer player;
  ASSERT_NE(player.web, 0);
  WebClient one(player.web);
  WebClient two(player.web);
  const osc::test::Client udp;
  for (WebClient* client : {&one, &two}) {
    ASSERT_EQ(client->upgrade().status, 101);
    client->listen("/scene/wind");
    EXPECT_EQ(client->receive(2, "/scene/wind").payload, one_float("/scene/wind", 0));
  }
  udp.send(player.osc, Bytes().text("/subscribe").text(",sf").text("/scene/wind").f(100).str());
  EXPECT_EQ(udp.receive(), one_float("/scene/wind", 0));

  one.binary(one_float("/scene/wind", 3));
  EXPECT_EQ(two.receive(2, "").payload, one_float("/scene/wind", 3));
  EXPECT_EQ(udp.receive(), one_float("/scene/wind", 3));
  udp.send(player.osc, one_float("/scene/wind", 4));
  EXPECT_EQ(one.receive(2, "").payload, one_float("/scene/wind", 4)) << "not its own 3";
  EXPECT_EQ(two.receive(2, "").payload, one_float("/scene/wind", 4));
  two.binary(one_float("/scene/wind", 5));
  EXPECT_EQ(one.receive(2, "").payload, one_float("/scene/wind", 5));
  EXPECT_EQ(udp.receive(), one_float("/scene/wind", 5)) << "not its own 4";
  EXPECT_EQ(one.until_pong("one"), std::vector<std::string>{});
  EXPECT_EQ(two.until_pong("two"), std::vector<std::string>{});
  // the sender receives its own value if it was clamped
  one.binary(one_float("/scene/wind", 99));
  EXPECT_EQ(one.receive(2, "").payload, one_float("/scene/wind", 10));
}

TEST(Query, SendsValuesAndRepliesOfEveryKind) {
  const WebPlayer player;
  WebClient client(player.web);
  ASSERT_EQ(client.upgrade().status, 101);
  client.binary(text_message("/scene/style", "wild"));
  client.listen("/scene/style");
  EXPECT_EQ(client.receive(2, "wild").payload, text_message("/scene/style", "wild"));
  client.listen("/physics/body/ball/part/ball/rotation");
  EXPECT_EQ(client.receive(2, "rotation").payload,
            Bytes().text("/physics/body/ball/part/ball/rotation").text(",[ffff]").f(0).f(0).f(0).f(1).str());
  client.listen("/physics/sim/paused");
  EXPECT_EQ(client.receive(2, "paused").payload, Bytes().text("/physics/sim/paused").text(",F").str());
  client.binary(Bytes().text("/transport/pause").text(",N").str());
  EXPECT_EQ(client.receive(2, "paused").payload, Bytes().text("/physics/sim/paused").text(",T").str());
  // queries and errors are answered through the same connection
  client.binary(text_message("/get", "/scene/wind"));
  EXPECT_EQ(client.receive(2, "/scene/wind").payload, one_float("/scene/wind", 0));
  client.binary(Bytes().text("/ping").str());
  EXPECT_EQ(client.receive(2, "/pong").opcode, 2);
  client.binary(one_float("/scene/wimd", 1));
  EXPECT_NE(client.receive(2, "/error").payload.find("/scene/wimd"), std::string::npos);
  client.binary(text_message("/subscribe", "/scene/wind"));
  EXPECT_NE(client.receive(2, "/error").payload.find("LISTEN"), std::string::npos);
  // invalid OSC is counted, as with UDP
  client.binary("\x01\x02 nonsense");
  client.binary(std::string(12, '\xff'));
  client.listen("/osc/malformed");
  EXPECT_EQ(client.receive(2, Bytes().text("/osc/malformed").text(",i").u32(2).str()).opcode, 2);
}

TEST(Query, TreeFollowsTheScene) {
  const WebPlayer player;
  WebClient client(player.web);
  WebClient http(player.web);
  ASSERT_EQ(client.upgrade().status, 101);
  client.listen("/scene/wind");
  client.receive(2, "/scene/wind");
  client.binary(Bytes().text("/more").str());
  EXPECT_EQ(client.receive(1, "PATH_").payload, R"({"COMMAND":"PATH_ADDED","DATA":"/physics/body/more"})");
  EXPECT_EQ(http.get("/physics/body/more/part/ball/mass?VALUE").body, R"({"VALUE":[0]})");
  client.binary(Bytes().text("/less").str());
  EXPECT_EQ(client.receive(1, "PATH_").payload, R"({"COMMAND":"PATH_REMOVED","DATA":"/physics/body/more"})");
  EXPECT_EQ(http.get("/physics/body/more").status, 404);
  const json info = json::parse(http.get("/?HOST_INFO").body);
  EXPECT_EQ(info["OSC_PORT"], player.osc.port);
}

TEST(Query, PageIsSelfContained) {
  const WebPlayer player;
  WebClient client(player.web);
  const oscquery::test::Reply page = client.get("/", "Accept: text/html\r\n");
  EXPECT_EQ(page.status, 200);
  EXPECT_TRUE(page.has_header("Content-Type: text/html; charset=utf-8"));
  EXPECT_TRUE(page.body.starts_with("<!doctype html>"));
  EXPECT_TRUE(page.body.find("</html>") != std::string::npos);
  EXPECT_EQ(page.body.find("@file:"), std::string::npos) << "every file is embedded";
  for (const char* outside : {"src=", "@import", "https://", "//cdn", "href=\"http"})
    EXPECT_EQ(page.body.find(outside), std::string::npos) << outside;
  // the only URLs are SVG's namespace
  std::size_t addresses = 0;
  for (std::size_t at = page.body.find("http:"); at != std::string::npos; at = page.body.find("http:", at + 1)) {
    EXPECT_EQ(page.body.substr(at, 26), "http://www.w3.org/2000/svg") << page.body.substr(at, 60);
    addresses++;
  }
  EXPECT_GT(addresses, 0u);
  EXPECT_LT(page.body.size(), 100000u) << "loads quickly on a phone";
}

TEST(Query, ListensOnTheGivenPort) {
  TempFolder folder;
  // uses a port that was free just now, and another one if it is in use meanwhile
  bool listens = false;
  for (int attempt = 0; attempt < 20 && !listens; attempt++) {
    const std::string port = PortInUse(SOCK_STREAM).port();
    Process running(limber_command(
        {folder.file("s.lua", kWindyScene), "--osc-in", "127.0.0.1:0", "--osc-out", "off", "--query", port}));
    listens = running.wait_for("remote panel http://127.0.0.1:" + port + "/");
  }
  EXPECT_TRUE(listens);
  const std::string scene = folder.file("s.lua", kWindyScene);
  const RunResult off = run({scene, "--fast", "--ticks", "1"});
  EXPECT_NE(off.err.find("OSCQuery off"), std::string::npos) << off.err;
  const RunResult on = run({scene, "--fast", "--ticks", "1", "--query", "127.0.0.1:0"});
  EXPECT_NE(on.err.find("remote panel http://127.0.0.1:"), std::string::npos) << on.err;
}

TEST(Query, OptionalPortMayBeInUse) {
  TempFolder folder;
  WebPlayer first;
  const std::string port = std::to_string(first.web);
  const std::vector<std::string> words = {folder.file("s.lua", kWindyScene), "--fast", "--ticks", "3", "--query", port};
  const RunResult result = run(words);
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("OSCQuery can't listen on 127.0.0.1:" + port), std::string::npos) << result.err;
  std::vector<std::string> optional = words;
  optional.emplace_back("--osc-optional");
  const RunResult played = run(optional);
  EXPECT_EQ(played.code, 0) << played.err;
  EXPECT_NE(played.err.find("OSCQuery off"), std::string::npos) << played.err;
}

TEST(Query, RejectsSendersThatAreNotAllowed) {
  const WebPlayer player({"--osc-allow", "192.0.2.0/24"});
  WebClient client(player.web);
  EXPECT_EQ(client.get("/").status, 403);
}

}  // namespace
}  // namespace limber::app::test
