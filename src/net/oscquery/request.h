// Answers HTTP requests: access checks, the panel's page, OSCQuery paths and attributes. Does no I/O. [any]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/output/value_snapshot.h"

namespace limber::oscquery {

/// The relevant parts of a request. Untrusted text.
struct HttpRequest {
  std::string method;
  std::string target;  ///< "/physics/sim/gravity?VALUE"
  std::optional<std::string> host;
  std::optional<std::string> origin;
  std::string accept;
  bool keep_alive = true;
};

/// A response to an HTTP request.
struct HttpResponse {
  int status = 200;
  std::string_view type = "application/json";
  std::string body;
  std::string policy;  ///< Content-Security-Policy of an HTML page.
};

/// Names and OSC port of the server.
struct HostInfo {
  std::vector<std::string> names;         ///< Names of this machine, in addition to localhost and IP addresses.
  std::optional<std::uint16_t> osc_port;  ///< Empty: OSC input by UDP is off.
};

/// Returns the rejection of a request from another site's page (header Origin) or for an unknown host name (header
/// Host, which protects against DNS rebinding).
std::optional<HttpResponse> reject_unknown_origin(const HttpRequest& request, const HostInfo& info);

/// Returns the response if it does not depend on the tree: the panel's page, HOST_INFO, rejections.
std::optional<HttpResponse> respond_without_tree(const HttpRequest& request, const HostInfo& info);

/// Returns the response for a path of the tree.
HttpResponse respond_from_tree(const HttpRequest& request, const engine::ValueSnapshot& snapshot);

/// Returns the HOST_INFO document, `{"NAME":…,"EXTENSIONS":{…},…}`.
std::string host_info_json(const HostInfo& info);

}  // namespace limber::oscquery
