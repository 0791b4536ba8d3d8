// A WebSocket connection after its upgrade: passes incoming frames to a QueryClient and sends outgoing frames in few
// system calls. [query]
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "net/oscquery/connection.h"

namespace limber::oscquery {

/// Accepts the upgrade and serves the client until either side closes the connection.
void serve_web_socket(boost::beast::tcp_stream stream,
                      const boost::beast::http::request<boost::beast::http::empty_body>& upgrade, QueryContext& context,
                      ConnectionSlot slot);

}  // namespace limber::oscquery
