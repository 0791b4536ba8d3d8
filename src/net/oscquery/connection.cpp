// Handles one request at a time: the next is read after the response to the previous one has been sent.
#include "net/oscquery/connection.h"

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "net/oscquery/web_socket.h"

namespace limber::oscquery {

namespace beast = boost::beast;
namespace http = boost::beast::http;

namespace {

constexpr int kLingerSeconds = 2;
constexpr int kMaxRejected = 64;  // maximum number of rejected connections that are answered at the same time
constexpr std::size_t kDiscardSize = 16384;  // bytes
// minimum transfer rate expected of clients, bytes/s; extends the timeout of large responses
constexpr std::size_t kMinTransferRate = 100000;

std::optional<std::string> field(const http::request<http::empty_body>& request, http::field name) {
  const auto at = request.find(name);
  if (at == request.end()) return std::nullopt;
  return std::string(at->value());
}

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(boost::asio::ip::tcp::socket socket, ConnectionContext& context, const system::IpAddress& address,
             bool accepted)
      : context_(context), slot_(context, address, accepted), stream_(std::move(socket)) {}
  ~Connection() { context_.response_bytes -= response_bytes_; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(QueryLimits::kHeader);
    parser_->body_limit(0);
    stream_.expires_after(std::chrono::seconds(QueryLimits::kReadSeconds));
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      self->handle_request(error);
    });
  }

  /// Responds that there are too many connections.
  void reject_too_many() {
    write({503, "text/plain; charset=utf-8", "too many connections in total or from this address; close some\n", {}},
          false, false);
  }
  /// Responds that the client's address is not allowed.
  void reject_address() {
    write({403, "text/plain; charset=utf-8", "this address is not in --osc-allow\n", {}}, false, false);
  }

 private:
  void handle_request(beast::error_code error) {
    if (error) {
      if (const int status = status_of(error))
        write({status, "text/plain", "this is not a valid HTTP request\n", {}}, false, false);
      return;
    }
    const http::request<http::empty_body>& message = parser_->get();
    HttpRequest request;
    request.method = std::string(message.method_string());
    request.target = std::string(message.target());
    request.host = field(message, http::field::host);
    request.origin = field(message, http::field::origin);
    request.accept = field(message, http::field::accept).value_or("");
    request.keep_alive = message.keep_alive();
    const bool head = message.method() == http::verb::head;
    const bool keep_alive = request.keep_alive;
    QueryContext* const web_sockets = context_.web_sockets();
    if (web_sockets != nullptr && beast::websocket::is_upgrade(message)) {
      if (std::optional<HttpResponse> rejection = reject_unknown_origin(request, web_sockets->hub.info()))
        return write(std::move(*rejection), false, false);
      return serve_web_socket(std::move(stream_), message, *web_sockets, std::move(slot_));
    }
    stream_.expires_never();  // the hub's request timeout is shorter
    context_.handle_request(std::move(request), [self = shared_from_this(), head, keep_alive](HttpResponse response) {
      self->write(std::move(response), head, keep_alive);
    });
  }

  // Returns the HTTP status for invalid input, or 0 if the connection ended.
  static int status_of(beast::error_code error) {
    if (error == http::error::end_of_stream || error == http::error::partial_message) return 0;
    if (error.category() != make_error_code(http::error::bad_method).category()) return 0;
    if (error == http::error::header_limit || error == http::error::buffer_overflow) return 431;
    return error == http::error::body_limit || error == http::error::unexpected_body ? 413 : 400;
  }

  void write(HttpResponse response, bool head, bool keep_alive) {
    if (context_.response_bytes + response.body.size() > QueryLimits::kResponses)
      response = {503, "text/plain; charset=utf-8", "too many large responses at once; try again\n", {}};
    response_ = {};
    response_.version(11);
    response_.result(static_cast<unsigned>(response.status));
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    if (!response.type.empty())
      response_.set(http::field::content_type, beast::string_view(response.type.data(), response.type.size()));
    if (response.status == 405) response_.set(http::field::allow, "GET, HEAD");
    if (!response.policy.empty()) {
      response_.set("Content-Security-Policy", response.policy);
      response_.set("Referrer-Policy", "no-referrer");
    }
    response_.keep_alive(keep_alive);
    response_.content_length(response.body.size());
    if (!head) response_.body() = std::move(response.body);
    response_bytes_ = response_.body().size();
    context_.response_bytes += response_bytes_;
    stream_.expires_after(std::chrono::seconds(QueryLimits::kWriteSeconds + response_bytes_ / kMinTransferRate));
    http::async_write(stream_, response_,
                      [self = shared_from_this()](beast::error_code error, std::size_t) { self->written(error); });
  }

  void written(beast::error_code error) {
    context_.response_bytes -= std::exchange(response_bytes_, 0);
    response_.body().clear();
    response_.body().shrink_to_fit();
    if (error) return;
    if (response_.keep_alive()) return read();
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
    stream_.expires_after(std::chrono::seconds(kLingerSeconds));
    discard_input();
  }

  // Discards unread input: closing the socket before it is read would reset the connection and lose the response.
  void discard_input() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(kDiscardSize),
                            [self = shared_from_this()](beast::error_code error, std::size_t) {
                              if (!error) self->discard_input();
                            });
  }

  ConnectionContext& context_;
  ConnectionSlot slot_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{QueryLimits::kHeader + QueryLimits::kFrame};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
  std::size_t response_bytes_ = 0;
};

system::IpAddress address_of(const boost::asio::ip::address& address) {
  if (address.is_v4()) return address.to_v4().to_uint();
  system::IpAddress ip(0, 0, static_cast<std::uint32_t>(address.to_v6().scope_id()));
  const boost::asio::ip::address_v6::bytes_type bytes = address.to_v6().to_bytes();
  for (std::size_t i = 0; i < 8; i++) {
    ip.high = ip.high << 8U | bytes[i];
    ip.low = ip.low << 8U | bytes[8 + i];
  }
  return ip;
}

}  // namespace

void serve_connection(boost::asio::ip::tcp::socket socket, ConnectionContext& context) {
  boost::system::error_code error;
  const auto peer = socket.remote_endpoint(error);
  const bool known = !error;
  const system::IpAddress address = known ? address_of(peer.address()) : system::IpAddress();
  const bool allowed = !known || context.is_allowed(address);
  const bool accepted = allowed && !context.full(address);
  if (!accepted && context.rejected >= kMaxRejected) return;
  const auto connection = std::make_shared<Connection>(std::move(socket), context, address, accepted);
  if (accepted) return connection->read();
  allowed ? connection->reject_too_many() : connection->reject_address();
}

}  // namespace limber::oscquery
