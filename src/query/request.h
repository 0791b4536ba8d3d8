// HTTP requests answered: who may ask, the panel's page, OSCQuery's paths and attributes. Knows no sockets. [any]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image.h"

namespace limber {

/// What of a request counts. Text from outside, of any content.
struct HttpRequest {
  std::string method;
  std::string target;  ///< "/physics/sim/gravity?VALUE"
  std::optional<std::string> host;
  std::optional<std::string> origin;
  std::string accept;
  bool keep_alive = true;
};

struct HttpAnswer {
  int status = 200;
  std::string_view type = "application/json";
  std::string body;
  std::string policy;  ///< Content-Security-Policy, of a page.
};

/// What the server is called and where its OSC comes in.
struct HostInfo {
  std::vector<std::string> names;         ///< Names of this machine, beside localhost and numbers.
  std::optional<std::uint16_t> osc_port;  ///< Nothing: no OSC comes in by UDP.
};

/// Why this request is not answered at all: a page of another site asks (Origin), or asks by a name of its own for this
/// machine (Host).
std::optional<HttpAnswer> refuse_stranger(const HttpRequest& request, const HostInfo& info);

/// The answer, where none of the tree is needed for it: the panel's page, HOST_INFO, refusals.
std::optional<HttpAnswer> answer_at_once(const HttpRequest& request, const HostInfo& info);

/// The answer from the tree.
HttpAnswer answer_from(const HttpRequest& request, const Image& image);

/// `{"NAME":…,"EXTENSIONS":{…},…}`
std::string host_info_json(const HostInfo& info);

}  // namespace limber
