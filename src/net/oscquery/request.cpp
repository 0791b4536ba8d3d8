// OSCQuery paths and attributes with the status codes that it defines: 204 no content, 400, 403, 404.
#include "net/oscquery/request.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/system/net/socket.h"
#include "base/text.h"
#include "net/oscquery/attributes.h"
#include "net/oscquery/page.h"
#include "net/oscquery/tree_json.h"

namespace limber::oscquery {

namespace {

constexpr std::string_view kText = "text/plain; charset=utf-8";
// attributes of the OSCQuery proposal that are not used here
constexpr std::array<std::string_view, 4> kUnusedAttributes = {"TAGS", "CRITICAL", "OVERLOADS", "HTML"};
// requests of other OSCQuery servers that modify the tree
constexpr std::array<std::string_view, 3> kModifyingRequests = {"ADD_NODE", "REMOVE_NODE", "RENAME_NODE"};
constexpr std::array<std::string_view, 8> kExtensions = {"LISTEN",       "IGNORE",       "PATH_ADDED",  "PATH_REMOVED",
                                                         "PATH_CHANGED", "LIMBER_DEPTH", "LIMBER_FIND", "LIMBER_LOG"};

HttpResponse rejection(int status, const std::string& text) { return {status, kText, text + "\n", {}}; }

HttpResponse json_response(std::string json) { return {200, "application/json", std::move(json), {}}; }
HttpResponse no_content() { return {204, "", "", {}}; }

// The page may load nothing and connect only to this server; the WebSocket address is listed because not every browser
// includes it in 'self'.
HttpResponse page_response(const std::string& host) {
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

// Removes the port from "name:9003", and the brackets as well from "[::1]:9003".
std::string_view host_name(std::string_view host) {
  if (host.starts_with('[')) return host.substr(1, std::min(host.find(']'), host.size()) - 1);
  return host.substr(0, host.find(':'));
}

// A parsed request target: the path, still escaped, and the query after the question mark.
struct ParsedTarget {
  std::string_view path;
  std::string_view key;
  std::string_view value;
  bool has_query = false;
};

ParsedTarget parse_target(std::string_view target) {
  target = target.substr(0, target.find('#'));
  // absolute form "http://host/path", as sent to a proxy
  if (target.starts_with("http://")) {
    const std::size_t slash = target.find('/', 7);
    target = slash == std::string_view::npos ? "/" : target.substr(slash);
  }
  ParsedTarget out;
  const std::size_t mark = target.find('?');
  out.path = target.substr(0, mark);
  if (mark == std::string_view::npos) return out;
  out.has_query = true;
  std::string_view query = target.substr(mark + 1);
  query = query.substr(0, query.find('&'));
  const std::size_t equals = query.find('=');
  out.key = query.substr(0, equals);
  if (equals != std::string_view::npos) out.value = query.substr(equals + 1);
  return out;
}

// Finds a path that is escaped like an address, or additionally percent-encoded by the HTTP client.
Result<TreePropertyRef> find(const TreeSnapshot& tree, std::string_view path) {
  Result<TreePropertyRef> ref = tree.find(path);
  if (ref || path.find('%') == std::string_view::npos) return ref;
  const Result<TreePropertyRef> unescaped = tree.find(unescape_name(path));
  return unescaped ? unescaped : ref;
}

HttpResponse attribute_of(const engine::ValueSnapshot& snapshot, const TreePropertyRef& ref, std::string_view name) {
  const auto member = [&](std::string_view json) { return json_response(fmt::format(R"({{"{}":{}}})", name, json)); };
  HttpResponse nothing = no_content();
  if (name == "FULL_PATH") return member(json_text(snapshot.tree->path(ref)));
  if (name == "VALUE") {
    const std::string value = property_value_json(snapshot, ref);
    return value.empty() ? nothing : member(value);
  }
  if (ref.property == nullptr) {
    if (name == "ACCESS") return member("0");
    if (name == "TYPE") return json_response("{}");
    if (name != "CONTENTS") return nothing;
    const std::string node = node_json(snapshot, ref);
    const std::size_t at = node.find(R"("CONTENTS":)");
    return json_response("{" + node.substr(at));
  }
  for (const auto& [attribute, json] : attributes_of(*ref.property)) {
    if (attribute == name) return member(json);
  }
  return nothing;
}

}  // namespace

std::optional<HttpResponse> reject_unknown_origin(const HttpRequest& request, const HostInfo& info) {
  if (!request.host) return rejection(400, "the request must have a Host header");
  const std::string host = lower(*request.host);
  std::string name(host_name(host));
  if (name.ends_with('.')) name.pop_back();
  const bool known =
      name == "localhost" || system::is_ip_address(name) ||
      std::any_of(info.names.begin(), info.names.end(), [&](const std::string& n) { return lower(n) == name; });
  if (!known) {
    return rejection(403,
                     fmt::format("'{}' is not a name of this machine; use its IP address (such as 127.0.0.1) or its "
                                 "name, or allow this one with --query-name",
                                 printable(shortened(name, 100))));
  }
  // browsers send the origin of the page that makes the request
  if (request.origin && lower(*request.origin) != "http://" + host)
    return rejection(
        403, fmt::format("requests by pages of '{}' are not allowed", printable(shortened(*request.origin, 100))));
  return std::nullopt;
}

std::optional<HttpResponse> respond_without_tree(const HttpRequest& request, const HostInfo& info) {
  if (std::optional<HttpResponse> rejection = reject_unknown_origin(request, info)) return rejection;
  if (request.method != "GET" && request.method != "HEAD") {
    return rejection(405, "only GET is supported; set values by OSC over UDP or this port's WebSocket");
  }
  const ParsedTarget target = parse_target(request.target);
  if (!target.path.starts_with('/')) return rejection(400, "the path must begin with /");
  if (!target.has_query) {
    if (target.path != "/" || request.accept.find("text/html") == std::string::npos) return std::nullopt;
    return page_response(*request.host);
  }
  if (target.key == "HOST_INFO") return json_response(host_info_json(info));
  if (contains(kModifyingRequests, target.key))
    return rejection(403, "the tree is read-only; objects are added and removed by the scene's script");
  if (contains(kUnusedAttributes, target.key)) return no_content();
  if (target.key == "LIMBER_DEPTH" || target.key == "LIMBER_FIND" || contains(known_attributes(), target.key))
    return std::nullopt;
  return rejection(400, fmt::format("attribute '{}' not found{}", printable(shortened(target.key, 100)),
                                    name_hint(target.key.substr(0, 100), known_attributes())));
}

HttpResponse respond_from_tree(const HttpRequest& request, const engine::ValueSnapshot& snapshot) {
  const ParsedTarget target = parse_target(request.target);
  const Result<TreePropertyRef> ref = find(*snapshot.tree, target.path);
  if (!ref) return rejection(404, ref.error());
  if (!target.has_query) return json_response(node_json(snapshot, *ref));
  if (target.key == "LIMBER_DEPTH") {
    const std::optional<double> depth = parse_number(target.value);
    if (!depth || *depth < 0 || *depth > 64) return rejection(400, "LIMBER_DEPTH must be 0 to 64");
    return json_response(node_json(snapshot, *ref, static_cast<int>(*depth)));
  }
  if (target.key == "LIMBER_FIND") {
    std::string words = unescape_name(target.value);
    std::replace(words.begin(), words.end(), '+', ' ');
    return json_response(find_json(snapshot, shortened(words, 256)));
  }
  return attribute_of(snapshot, *ref, target.key);
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

}  // namespace limber::oscquery
