// Any text as what a request says: target, host, origin, accepted types, method, one a line ("-": none). The answer is
// one of OSCQuery's, its JSON is JSON, and nobody is let in whose host is not ours.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/text.h"
#include "engine/everything.h"
#include "engine/image_of.h"
#include "fuzz/target.h"
#include "query/request.h"

namespace {

using namespace limber;

// a world that stands still: requests change nothing
std::shared_ptr<const Image> make_image() {
  log_to_stderr(false);
  const engine_test::SceneFile file(std::string(engine_test::kEverything) +
                                    "sim:add_body('a b')\nsim:add_body('c/d%')\n");
  engine_test::Show show(file.path());
  return engine_test::image_of(show);
}

std::optional<std::string> header(std::string_view line) {
  return line == "-" ? std::nullopt : std::optional(std::string(line));
}

void check(const HttpAnswer& answer) {
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
  static const std::shared_ptr<const Image>& image = *new std::shared_ptr<const Image>(make_image());
  static const HostInfo info{{"stage", "stage.local"}, 9003};
  std::vector<std::string_view> lines = split({reinterpret_cast<const char*>(data), size}, '\n');
  lines.resize(5, "-");
  HttpRequest request;
  request.target = lines[0];
  request.host = header(lines[1]);
  request.origin = header(lines[2]);
  request.accept = lines[3];
  request.method = lines[4];
  const std::optional<HttpAnswer> stranger = refuse_stranger(request, info);
  const std::optional<HttpAnswer> at_once = answer_at_once(request, info);
  if (stranger) must(at_once && at_once->status == stranger->status && stranger->status >= 400);
  if (at_once) {
    check(*at_once);
  } else {
    check(answer_from(request, *image));
  }
  return 0;
}
