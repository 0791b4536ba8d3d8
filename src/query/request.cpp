// Paths and attributes of OSCQuery; the statuses are its own: 204 nothing to tell, 400, 403, 404.
#include "query/request.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/system/socket.h"
#include "base/text.h"
#include "query/page.h"
#include "query/row_face.h"
#include "query/tree_json.h"

namespace limber {

namespace {

constexpr std::string_view kText = "text/plain; charset=utf-8";
// attributes of the proposal that nothing here has
constexpr std::array<std::string_view, 4> kUnused = {"TAGS", "CRITICAL", "OVERLOADS", "HTML"};
// requests of other servers' clients that would change the tree
constexpr std::array<std::string_view, 3> kChanging = {"ADD_NODE", "REMOVE_NODE", "RENAME_NODE"};
constexpr std::array<std::string_view, 8> kExtensions = {"LISTEN",       "IGNORE",       "PATH_ADDED",  "PATH_REMOVED",
                                                         "PATH_CHANGED", "LIMBER_DEPTH", "LIMBER_FIND", "LIMBER_LOG"};

HttpAnswer refusal(int status, const std::string& text) { return {status, kText, text + "\n", {}}; }

HttpAnswer json_answer(std::string json) { return {200, "application/json", std::move(json), {}}; }
HttpAnswer nothing_to_tell() { return {204, "", "", {}}; }

// the page may load nothing, and speak with this server alone; not every browser counts a WebSocket to it as 'self'
HttpAnswer page_answer(const std::string& host) {
  const bool plain = std::all_of(host.begin(), host.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == ':' || c == '[' || c == ']';
  });
  std::string policy = fmt::format(
      "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
      "form-action 'none'; frame-ancestors 'none'; connect-src 'self'{}",
      plain ? " ws://" + host : "");
  return {200, "text/html; charset=utf-8", std::string(panel_page()), std::move(policy)};
}

template <class List>
bool contains(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// "name:9003" without the port, "[::1]:9003" without it and the brackets
std::string_view host_name(std::string_view host) {
  if (host.starts_with('[')) return host.substr(1, std::min(host.find(']'), host.size()) - 1);
  return host.substr(0, host.find(':'));
}

// a request's target: the path as it was sent, and what stands behind the ?
struct Target {
  std::string_view path;
  std::string_view key;
  std::string_view value;
  bool asks = false;
};

Target parse_target(std::string_view target) {
  target = target.substr(0, target.find('#'));
  // "http://host/path", as to a proxy
  if (target.starts_with("http://")) {
    const std::size_t slash = target.find('/', 7);
    target = slash == std::string_view::npos ? "/" : target.substr(slash);
  }
  Target out;
  const std::size_t mark = target.find('?');
  out.path = target.substr(0, mark);
  if (mark == std::string_view::npos) return out;
  out.asks = true;
  std::string_view query = target.substr(mark + 1);
  query = query.substr(0, query.find('&'));
  const std::size_t equals = query.find('=');
  out.key = query.substr(0, equals);
  if (equals != std::string_view::npos) out.value = query.substr(equals + 1);
  return out;
}

// as addresses are written, or as HTTP writes them once more
Result<TreePlace> find(const Tree& tree, std::string_view path) {
  Result<TreePlace> place = tree.find(path);
  if (place || path.find('%') == std::string_view::npos) return place;
  const Result<TreePlace> again = tree.find(unescape_name(path));
  return again ? again : place;
}

HttpAnswer attribute_of(const Image& image, const TreePlace& place, std::string_view name) {
  const auto member = [&](std::string_view json) { return json_answer(fmt::format(R"({{"{}":{}}})", name, json)); };
  HttpAnswer nothing = nothing_to_tell();
  if (name == "FULL_PATH") return member(json_text(image.tree->path(place)));
  if (name == "VALUE") {
    const std::string value = place_value_json(image, place);
    return value.empty() ? nothing : member(value);
  }
  if (place.row == nullptr) {
    if (name == "ACCESS") return member("0");
    if (name == "TYPE") return json_answer("{}");
    if (name != "CONTENTS") return nothing;
    const std::string node = node_json(image, place);
    const std::size_t at = node.find(R"("CONTENTS":)");
    return json_answer("{" + node.substr(at));
  }
  for (const auto& [attribute, json] : attributes_of(*place.row)) {
    if (attribute == name) return member(json);
  }
  return nothing;
}

}  // namespace

std::optional<HttpAnswer> refuse_stranger(const HttpRequest& request, const HostInfo& info) {
  if (!request.host) return refusal(400, "a request must name its host");
  const std::string host = lower(*request.host);
  std::string name(host_name(host));
  if (name.ends_with('.')) name.pop_back();
  const bool ours =
      name == "localhost" || system::is_ip_address(name) ||
      std::any_of(info.names.begin(), info.names.end(), [&](const std::string& n) { return lower(n) == name; });
  if (!ours) {
    return refusal(
        403, fmt::format("'{}' is no name of this machine; ask for its number (such as 127.0.0.1) or its name, or "
                         "allow this one by --query-name",
                         printable(shortened(name, 100))));
  }
  // a browser says which site's page asks
  if (request.origin && lower(*request.origin) != "http://" + host)
    return refusal(403, fmt::format("pages of '{}' may not ask here", printable(shortened(*request.origin, 100))));
  return std::nullopt;
}

std::optional<HttpAnswer> answer_at_once(const HttpRequest& request, const HostInfo& info) {
  if (std::optional<HttpAnswer> stranger = refuse_stranger(request, info)) return stranger;
  if (request.method != "GET" && request.method != "HEAD") {
    return refusal(405, "only GET is answered; values are set by OSC, over UDP or this port's WebSocket");
  }
  const Target target = parse_target(request.target);
  if (!target.path.starts_with('/')) return refusal(400, "a path begins with /");
  if (!target.asks) {
    if (target.path != "/" || request.accept.find("text/html") == std::string::npos) return std::nullopt;
    return page_answer(*request.host);
  }
  if (target.key == "HOST_INFO") return json_answer(host_info_json(info));
  if (contains(kChanging, target.key))
    return refusal(403, "the tree is the scene's: things come and go by its script, not by requests");
  if (contains(kUnused, target.key)) return nothing_to_tell();
  if (target.key == "LIMBER_DEPTH" || target.key == "LIMBER_FIND" || contains(known_attributes(), target.key))
    return std::nullopt;
  return refusal(400, fmt::format("there is no attribute '{}'{}", printable(shortened(target.key, 100)),
                                  name_hint(target.key.substr(0, 100), known_attributes())));
}

HttpAnswer answer_from(const HttpRequest& request, const Image& image) {
  const Target target = parse_target(request.target);
  const Result<TreePlace> place = find(*image.tree, target.path);
  if (!place) return refusal(404, place.error());
  if (!target.asks) return json_answer(node_json(image, *place));
  if (target.key == "LIMBER_DEPTH") {
    const std::optional<double> depth = parse_number(target.value);
    if (!depth || *depth < 0 || *depth > 64) return refusal(400, "LIMBER_DEPTH is 0 to 64 levels");
    return json_answer(node_json(image, *place, static_cast<int>(*depth)));
  }
  if (target.key == "LIMBER_FIND") {
    std::string words = unescape_name(target.value);
    std::replace(words.begin(), words.end(), '+', ' ');
    return json_answer(find_json(image, shortened(words, 256)));
  }
  return attribute_of(image, *place, target.key);
}

std::string host_info_json(const HostInfo& info) {
  std::string text = fmt::format(R"({{"NAME":{},"EXTENSIONS":{{)", json_text(fmt::format("Limber {}", version())));
  for (const std::string_view attribute : known_attributes()) {
    if (attribute != "FULL_PATH" && attribute != "CONTENTS" && attribute != "TYPE")
      text += fmt::format(R"("{}":true,)", attribute);
  }
  for (const std::string_view extension : kExtensions)
    text += fmt::format(R"({}"{}":true)", extension == kExtensions.front() ? "" : ",", extension);
  text += R"(},"OSC_TRANSPORT":"UDP")";
  if (info.osc_port) text += fmt::format(R"(,"OSC_PORT":{})", *info.osc_port);
  return text + "}";
}

}  // namespace limber
