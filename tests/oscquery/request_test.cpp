// HTTP requests and responses: OSCQuery's status codes, and requests of unknown origin.
#include "net/oscquery/request.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/everything.h"
#include "engine/image_of.h"

namespace limber::oscquery {
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

struct RequestFixture {
  engine::test::SceneFile file{std::string(engine::test::kEverything) + "sim:add_body('a b')\nsim:add_body('c/d')\n"};
  engine::test::Show show{file.path()};
  std::shared_ptr<const engine::ValueSnapshot> snapshot = engine::test::make_value_snapshot(show);

  HttpResponse get(const std::string& target, const std::string& accept = "*/*") const {
    const HttpRequest request = request_for(target, accept);
    const std::optional<HttpResponse> known = respond_without_tree(request, kInfo);
    return known ? *known : respond_from_tree(request, *snapshot);
  }
};

TEST(Request, AnswersPathsAndAttributes) {
  const RequestFixture fixture;
  struct Case {
    const char* target;
    int status;
    const char* body;  // as JSON; empty: not checked
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
      // attributes that it does not have
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
      // names with characters that addresses don't allow, escaped for addresses or for HTTP
      {"/physics/body/a%20b?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/a%20b"})"},
      {"/physics/body/a%2520b?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/a%20b"})"},
      {"/physics/body/c%2Fd?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/c%2Fd"})"},
      {"/physics/body/c%252Fd?FULL_PATH", 200, R"({"FULL_PATH":"/physics/body/c%2Fd"})"},
      {"/physics/body/c/d?FULL_PATH", 404, ""},
      {"/%00?VALUE", 404, ""},
      // depth and search
      {"/physics?LIMBER_DEPTH=0", 200, R"({"FULL_PATH":"/physics","ACCESS":0,"CONTENTS":{}})"},
      {"/physics?LIMBER_DEPTH=-1", 400, ""},
      {"/physics?LIMBER_DEPTH=many", 400, ""},
      {"/?LIMBER_FIND=", 200, R"({"FOUND":[],"MORE":false})"},
  };
  for (const Case& c : cases) {
    const HttpResponse response = fixture.get(c.target);
    EXPECT_EQ(response.status, c.status) << c.target << "\n" << response.body;
    if (*c.body != '\0') {
      EXPECT_EQ(json::parse(response.body, nullptr, false), json::parse(c.body)) << c.target;
    }
    EXPECT_EQ(response.body.empty(), c.status == 204) << "rejections have a text";
  }
}

TEST(Request, RejectionsSuggestNames) {
  const RequestFixture fixture;
  EXPECT_EQ(fixture.get("/scene/wimd").body, "there is no 'wimd' in /scene; did you mean 'wind'?\n");
  EXPECT_EQ(fixture.get("/scene/wind?VALUES").body, "attribute 'VALUES' not found; did you mean 'VALUE'?\n");
  EXPECT_EQ(fixture.get("/\x1b[31m").body.find('\x1b'), std::string::npos);
}

TEST(Request, AnswersContentsAndSearch) {
  const RequestFixture fixture;
  const json contents = json::parse(fixture.get("/scene?CONTENTS").body);
  EXPECT_EQ(contents.size(), 1u);
  EXPECT_EQ(contents["CONTENTS"]["wind"]["VALUE"], json::array({0}));
  const json found = json::parse(fixture.get("/?LIMBER_FIND=twin+hat%20mass").body);
  ASSERT_EQ(found["FOUND"].size(), 1u);
  EXPECT_EQ(found["FOUND"][0]["FULL_PATH"], "/physics/body/twin/part/hat/mass");
}

TEST(Request, AnswersHostInfo) {
  const RequestFixture fixture;
  for (const char* target : {"/?HOST_INFO", "/scene/wind?HOST_INFO=1", "/nowhere?HOST_INFO"}) {
    const json info = json::parse(fixture.get(target).body);
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

TEST(Request, ServesPageToBrowsersOnly) {
  const RequestFixture fixture;
  const HttpResponse page = fixture.get("/", "text/html,application/xhtml+xml,*/*;q=0.8");
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_NE(page.policy.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(page.policy.find("connect-src 'self' ws://127.0.0.1:9003"), std::string::npos);
  EXPECT_EQ(json::parse(fixture.get("/", "application/json").body)["FULL_PATH"], "/");
  EXPECT_EQ(json::parse(fixture.get("/", "*/*").body)["FULL_PATH"], "/");
  EXPECT_EQ(json::parse(fixture.get("/scene", "text/html").body)["FULL_PATH"], "/scene");
}

TEST(Request, RejectsOtherMethods) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "nonsense", ""}) {
    HttpRequest request = request_for("/scene/wind");
    request.method = method;
    EXPECT_EQ(respond_without_tree(request, kInfo)->status, 405) << method;
  }
}

// A page of another site that knows this port, and a name of another site that resolves to this machine (DNS
// rebinding).
TEST(Request, RejectsUnknownOrigins) {
  struct Case {
    std::optional<std::string> host;
    std::optional<std::string> origin;
    int status;  // 0: accepted
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
    const std::optional<HttpResponse> rejection = reject_unknown_origin(request, kInfo);
    EXPECT_EQ(rejection ? rejection->status : 0, c.status)
        << c.host.value_or("no host") << " " << c.origin.value_or("");
    if (rejection) {
      EXPECT_EQ(respond_without_tree(request, kInfo)->status, c.status);
    }
  }
}

}  // namespace
}  // namespace limber::oscquery
