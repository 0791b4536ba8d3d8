// Short names for the endpoint functions of the operating system layer.
#pragma once

#include "base/system/net/socket.h"

namespace limber::osc {

using system::Endpoint;
using system::endpoint_text;
using system::parse_ipv4;
using system::resolve;

}  // namespace limber::osc
