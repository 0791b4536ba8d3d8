// Short names for the endpoint functions of the operating system layer.
#pragma once

#include "base/system/net/socket.h"

namespace limber::osc {

using system::Endpoint;
using system::endpoint_text;
using system::host_port_text;
using system::ip_text;
using system::IpAddress;
using system::IpVersion;
using system::parse_ip;
using system::resolve;

}  // namespace limber::osc
