// Requests and their answers, the ones that OSCQuery has statuses for and the ones that come from strangers.
#include "query/request.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"

namespace limber {
namespace {

using nlohmann::json;

const HostInfo kInfo{{"stage", "stage.local"}, 9003};

HttpRequest request_for(std::string target, std::string accept = "*/*") {
  HttpRequest request;
  request.method = "GET";
  request.target = std::move(target);
  request.host = "127.0.0.1:9003";
  request.accept = std::move(accept);
  return request;
}

struct RequestStage {
  engine_test::SceneFile file{std::string(engine_test::kEverything) + "sim:add_body('a b')\nsim:add_body('c/d')\n"};
  engine_test::Show show{file.path()};
  std::shared_ptr<const Image> image = engine_test::image_of(show);

  HttpAnswer get(const std::string& target, const std::string& accept = "*/*") const {
    const HttpRequest request = request_for(target, accept);
    const std::optional<HttpAnswer> known = answer_at_once(request, kInfo);
    return known ? *known : answer_from(request, *image);
  }
};

TEST(Request, PathsAndAttributes) {
  const RequestStage stage;
  struct Case {
    const char* target;
    int status;
    const char* body;  // as JSON; empty: is not looked at
  };
  const std::vector<Case> cases = {
      {"/scene/wind?VALUE", 200, R"({"VALUE":[0]})"},
      {"/scene/wind?TYPE", 200, R"({"TYPE":"f"})"},
      {"/scene/wind?RANGE", 200, R"({"RANGE":[{"MIN":0,"MAX":10}]})"},
      {"/scene/wind?ACCESS", 200, R"({"ACCESS":3})"},
      {"/scene/wind?CLIPMODE", 200, R"({"CLIPMODE":["both"]})"},
      {"/scene/wind?DESCRIPTION", 200, R"({"DESCRIPTION":"A number"})"},
      {"/scene/wind?UNIT", 200, R"({"UNIT":["N"]})"},
      {"/scene/wind?FULL_PATH", 200, R"({"FULL_PATH":"/scene/wind"})"},
      {"/scene/wind/?VALUE", 200, R"({"VALUE":[0]})"},
      {"/Scene/WIND?VALUE=1&x=2", 200, R"({"VALUE":[0]})"},
      {"/scene/wind?VALUE#part", 200, R"({"VALUE":[0]})"},
      {"http://127.0.0.1:9003/scene/wind?VALUE", 200, R"({"VALUE":[0]})"},
      // what it has not
      {"/scene/lively?UNIT", 204, ""},
      {"/scene/lively?EXTENDED_TYPE", 204, ""},
      {"/scene/wind?CONTENTS", 204, ""},
      {"/transport/play?VALUE", 204, ""},
      {"/scene?VALUE", 204, ""},
      {"/scene/wind?TAGS", 204, ""},
      {"/scene/wind?CRITICAL", 204, ""},
      {"/scene?ACCESS", 200, R"({"ACCESS":0})"},
      {"/scene?TYPE", 200, "{}"},
      {"/scene/wind?VALUES", 400, ""},
      {"/scene/wind?value", 400, ""},
      {"/scene/wind?", 400, ""},
      {"/scene/wimd", 404, ""},
      {"/scene/wimd?VALUE", 404, ""},
      {"/scene/wind/deeper", 404, ""},
      {"scene", 400, ""},
      {"*", 400, ""},
      {"", 400, ""},
      {"//", 404, ""},
      {"/?ADD_NODE=x", 403, ""},
      {"/scene/wind?REMOVE_NODE", 403, ""},
      // names with characters that addresses don't take, written in an address's way or in HTTP's
      {"/physics/body/a%20b?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/a%20b"})"},
      {"/physics/body/a%2520b?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/a%20b"})"},
      {"/physics/body/c%2Fd?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/c%2Fd"})"},
      {"/physics/body/c%252Fd?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/c%2Fd"})"},
      {"/physics/body/c/d?FULL_PATH", 404, ""},
      {"/%00?VALUE", 404, ""},
      // levels, words
      {"/physics?LIMBER_DEPTH=0", 200, R"({"FULL_PATH":"/physics","ACCESS":0,"CONTENTS":{}})"},
      {"/physics?LIMBER_DEPTH=-1", 400, ""},
      {"/physics?LIMBER_DEPTH=many", 400, ""},
      {"/?LIMBER_FIND=", 200, R"({"FOUND":[],"MORE":false})"},
  };
  for (const Case& c : cases) {
    const HttpAnswer answer = stage.get(c.target);
    EXPECT_EQ(answer.status, c.status) << c.target << "\n" << answer.body;
    if (*c.body != '\0') {
      EXPECT_EQ(json::parse(answer.body, nullptr, false), json::parse(c.body)) << c.target;
    }
    EXPECT_EQ(answer.body.empty(), c.status == 204) << "a refusal says why";
  }
}

TEST(Request, RefusalsSayWhatThereIs) {
  const RequestStage stage;
  EXPECT_EQ(stage.get("/scene/wimd").body, "there is no 'wimd' in /scene; did you mean 'wind'?\n");
  EXPECT_EQ(stage.get("/scene/wind?VALUES").body, "there is no attribute 'VALUES'; did you mean 'VALUE'?\n");
  EXPECT_EQ(stage.get("/\x1b[31m").body.find('\x1b'), std::string::npos);
}

TEST(Request, ContentsAndWords) {
  const RequestStage stage;
  const json contents = json::parse(stage.get("/scene?CONTENTS").body);
  EXPECT_EQ(contents.size(), 1u);
  EXPECT_EQ(contents["CONTENTS"]["wind"]["VALUE"], json::array({0}));
  const json found = json::parse(stage.get("/?LIMBER_FIND=twin+hat%20mass").body);
  ASSERT_EQ(found["FOUND"].size(), 1u);
  EXPECT_EQ(found["FOUND"][0]["FULL_PATH"], "/physics/body/twin/part/hat/mass");
}

TEST(Request, HostInfo) {
  const RequestStage stage;
  for (const char* target : {"/?HOST_INFO", "/scene/wind?HOST_INFO=1", "/nowhere?HOST_INFO"}) {
    const json info = json::parse(stage.get(target).body);
    EXPECT_EQ(info["NAME"].get<std::string>().substr(0, 6), "Limber");
    EXPECT_EQ(info["OSC_PORT"], 9003);
    EXPECT_EQ(info["OSC_TRANSPORT"], "UDP");
    EXPECT_FALSE(info.contains("WS_PORT")) << "the same as HTTP's";
    for (const char* extension : {"ACCESS", "VALUE", "RANGE", "DESCRIPTION", "UNIT", "CLIPMODE", "LISTEN", "IGNORE",
                                  "PATH_ADDED", "PATH_REMOVED", "PATH_CHANGED"})
      EXPECT_EQ(info["EXTENSIONS"][extension], true) << extension;
  }
  EXPECT_FALSE(json::parse(host_info_json({{}, std::nullopt})).contains("OSC_PORT"));
}

TEST(Request, ABrowserGetsThePageOthersTheTree) {
  const RequestStage stage;
  const HttpAnswer page = stage.get("/", "text/html,application/xhtml+xml,*/*;q=0.8");
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_NE(page.policy.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(page.policy.find("connect-src 'self' ws://127.0.0.1:9003"), std::string::npos);
  EXPECT_EQ(json::parse(stage.get("/", "application/json").body)["FULL_PATH"], "/");
  EXPECT_EQ(json::parse(stage.get("/", "*/*").body)["FULL_PATH"], "/");
  EXPECT_EQ(json::parse(stage.get("/scene", "text/html").body)["FULL_PATH"], "/scene");
}

TEST(Request, OtherMethodsAreNotAnswered) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "nonsense", ""}) {
    HttpRequest request = request_for("/scene/wind");
    request.method = method;
    EXPECT_EQ(answer_at_once(request, kInfo)->status, 405) << method;
  }
}

// a page of another site that knows of this port; a name of another site that leads here (DNS rebinding)
TEST(Request, StrangersAreRefused) {
  struct Case {
    std::optional<std::string> host;
    std::optional<std::string> origin;
    int status;  // 0: let in
  };
  const std::vector<Case> cases = {
      {"127.0.0.1:9003", {}, 0},
      {"127.0.0.1", {}, 0},
      {"192.168.1.7:9003", {}, 0},
      {"localhost:9003", {}, 0},
      {"LOCALHOST.:80", {}, 0},
      {"[::1]:9003", {}, 0},
      {"stage:9003", {}, 0},
      {"Stage.local", {}, 0},
      {"127.0.0.1:9003", "http://127.0.0.1:9003", 0},
      {"Stage.local:9003", "http://stage.local:9003", 0},
      {{}, {}, 400},
      {"", {}, 403},
      {"evil.example", {}, 403},
      {"evil.example:9003", "http://evil.example:9003", 403},
      {"127.0.0.1.evil.example:9003", {}, 403},
      {"localhost.evil.example", {}, 403},
      {"127.0.0.1@evil.example", {}, 403},
      {"[::1", {}, 0},
      {"[", {}, 403},
      {"127.0.0.1:9003", "http://evil.example", 403},
      {"127.0.0.1:9003", "https://127.0.0.1:9003", 403},
      {"127.0.0.1:9003", "http://127.0.0.1:9004", 403},
      {"127.0.0.1:9003", "http://127.0.0.1:9003.evil.example", 403},
      {"127.0.0.1:9003", "null", 403},
      {"127.0.0.1:9003", "", 403},
  };
  for (const Case& c : cases) {
    HttpRequest request = request_for("/");
    request.host = c.host;
    request.origin = c.origin;
    const std::optional<HttpAnswer> refused = refuse_stranger(request, kInfo);
    EXPECT_EQ(refused ? refused->status : 0, c.status) << c.host.value_or("no host") << " " << c.origin.value_or("");
    if (refused) {
      EXPECT_EQ(answer_at_once(request, kInfo)->status, c.status);
    }
  }
}

}  // namespace
}  // namespace limber
