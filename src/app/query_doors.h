// OSCQuery wired to the OSC room: encoder, the way in, and where it listens.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "osc/network.h"
#include "query/server.h"

namespace limber {

/// `--query [ADDR:]PORT|off` as it was typed; empty text: not given. An empty list that is given means off.
Result<std::optional<std::vector<ListenAddress>>> parse_query(const std::string& text);

/// What the query room is handed. `network` outlives it.
QueryDoors query_doors(Network& network, std::vector<Cidr> allow, std::vector<std::string> names = {});

/// Why a name of `--query-name` is none; empty: it is one.
std::string host_name_fault(const std::string& name);

/// Where it listens: as the command line says, else on this machine under the number by which OSC comes in (9003 when
/// none does). Nothing: off.
std::optional<ListenAddress> query_address(const std::optional<std::vector<ListenAddress>>& wish, const OscPlan& osc);

/// "OSCQuery and remote panel http://127.0.0.1:9003/", for the lines at start.
std::string query_line(const std::optional<ListenAddress>& at, const QueryServer& server);

}  // namespace limber
