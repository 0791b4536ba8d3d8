// Connects the modules osc and query, which don't know each other.
#include "app/show/query_host.h"

#include <algorithm>
#include <cctype>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "net/osc/packets/encode.h"

namespace limber::app {

Result<std::optional<std::vector<ListenAddress>>> parse_query(const std::string& text) {
  if (text.empty()) return std::optional<std::vector<ListenAddress>>();
  Result<std::vector<ListenAddress>> list = osc::parse_listen("--query", text);
  if (!list) return Error{list.error()};
  if (list->size() > 1)
    return Error{fmt::format("--query '{}': one address is enough; write --query [ADDR:]PORT", printable(text))};
  return std::optional(std::move(*list));
}

std::string host_name_fault(const std::string& name) {
  const bool plain = !name.empty() && name.size() <= 253 && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_';
  });
  return plain ? ""
               : fmt::format("'{}' is not a host name; write it without http:// and port, such as vm.example", name);
}

oscquery::QueryHost query_host(osc::Network& network, std::vector<osc::Cidr> allow, std::vector<std::string> names) {
  oscquery::QueryHost host;
  host.names = std::move(names);
  host.encode = [buffer = std::make_shared<osc::PacketBuffer>()](const Message& message, std::string_view tags) {
    const std::span<const char> packet =
        tags.empty() ? osc::encode_message(message, *buffer) : osc::encode_tagged(message, tags, *buffer);
    return std::string(packet.begin(), packet.end());
  };
  host.process = [&network](const CommandOrigin& origin, std::string packet) {
    network.enqueue(origin, std::move(packet));
  };
  host.osc_port = [&network]() -> std::optional<std::uint16_t> {
    const std::vector<system::Endpoint> bound = network.bound();
    return bound.empty() ? std::nullopt : std::optional(bound.front().port);
  };
  host.is_allowed = [allow = std::move(allow)](const system::IpAddress& ip) { return osc::is_allowed(allow, ip); };
  return host;
}

std::optional<ListenAddress> query_address(const std::optional<std::vector<ListenAddress>>& requested,
                                           const OscConfig& osc) {
  if (requested) return requested->empty() ? std::nullopt : std::optional(requested->front());
  ListenAddress usual;
  if (!osc.listen.empty()) usual.port = osc.listen.front().port;
  return usual;
}

std::string query_line(const std::optional<ListenAddress>& at, const oscquery::QueryServer& server) {
  std::string line = "OSCQuery off";
  if (at && server.port() != 0)
    line = fmt::format("OSCQuery and remote panel http://{}/", system::host_port_text(at->address, server.port()));
  return line;
}

}  // namespace limber::app
