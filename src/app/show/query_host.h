// Connects OSCQuery to the OSC network: encoder, input of packets, and listening address.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "net/osc/network.h"
#include "net/oscquery/server.h"

namespace limber::app {

/// Parses `--query [ADDR:]PORT|off`. nullopt: not given (empty text); an empty list: off.
Result<std::optional<std::vector<ListenAddress>>> parse_query(const std::string& text);

/// Returns the callbacks that the OSCQuery server uses. `network` must outlive it.
oscquery::QueryHost query_host(osc::Network& network, std::vector<osc::Cidr> allow,
                               std::vector<std::string> names = {});

/// Returns the error of an invalid name in `--query-name`, else an empty string.
std::string host_name_fault(const std::string& name);

/// Returns the listening address: as given on the command line, else 127.0.0.1 with the port number of OSC input (9003
/// if that is off). nullopt: off.
std::optional<ListenAddress> query_address(const std::optional<std::vector<ListenAddress>>& requested,
                                           const OscConfig& osc);

/// Returns a line for the start, "OSCQuery and remote panel http://127.0.0.1:9003/".
std::string query_line(const std::optional<ListenAddress>& at, const oscquery::QueryServer& server);

}  // namespace limber::app
