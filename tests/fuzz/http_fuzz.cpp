// Fuzzes HTTP requests. Input: target, host, origin, accepted types and method, one per line ("-": absent). Checks that
// the response is valid for OSCQuery, JSON bodies are valid, and requests with an unknown host or origin are rejected.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/everything.h"
#include "engine/image_of.h"
#include "fuzz/target.h"
#include "net/oscquery/request.h"

namespace {

using namespace limber;

// a paused world, because requests change nothing
std::shared_ptr<const engine::ValueSnapshot> make_snapshot() {
  log_to_stderr(false);
  const engine::test::SceneFile file(std::string(engine::test::kEverything) +
                                     "sim:add_body('a b')\nsim:add_body('c/d%')\n");
  engine::test::Show show(file.path());
  return engine::test::make_value_snapshot(show);
}

std::optional<std::string> header(std::string_view line) {
  return line == "-" ? std::nullopt : std::optional(std::string(line));
}

void check(const oscquery::HttpResponse& answer) {
  const int s = answer.status;
  must(s == 200 || s == 204 || s == 400 || s == 403 || s == 404 || s == 405);
  if (s == 204) must(answer.body.empty());
  if (s >= 400)
    must(!answer.body.empty() && printable(answer.body) == answer.body.substr(0, answer.body.size() - 1) + "\n");
  if (answer.type == "application/json") must(nlohmann::json::accept(answer.body));
  must(answer.policy.find_first_of("\r\n") == std::string::npos);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::shared_ptr<const engine::ValueSnapshot>& snapshot =
      *new std::shared_ptr<const engine::ValueSnapshot>(make_snapshot());
  static const oscquery::HostInfo info{{"stage", "stage.local"}, 9003};
  std::vector<std::string_view> lines = split({reinterpret_cast<const char*>(data), size}, '\n');
  lines.resize(5, "-");
  oscquery::HttpRequest request;
  request.target = lines[0];
  request.host = header(lines[1]);
  request.origin = header(lines[2]);
  request.accept = lines[3];
  request.method = lines[4];
  const std::optional<oscquery::HttpResponse> rejected = oscquery::reject_unknown_origin(request, info);
  const std::optional<oscquery::HttpResponse> direct = oscquery::respond_without_tree(request, info);
  if (rejected) must(direct && direct->status == rejected->status && rejected->status >= 400);
  if (direct) {
    check(*direct);
  } else {
    check(oscquery::respond_from_tree(request, *snapshot));
  }
  return 0;
}
