// A WebSocket after its upgrade: frames in to a Client, frames out gathered into few system calls. [query]
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "query/connection.h"

namespace limber {

/// Answers the upgrade and serves the client until one of both ends it.
void serve_web_socket(boost::beast::tcp_stream stream,
                      const boost::beast::http::request<boost::beast::http::empty_body>& upgrade, QueryDesk& desk,
                      Seat seat);

}  // namespace limber
