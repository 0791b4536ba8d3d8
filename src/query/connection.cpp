// One request at a time; the next is read when the answer to the one before has gone.
#include "query/connection.h"

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

#include "query/web_socket.h"

namespace limber {

namespace beast = boost::beast;
namespace http = boost::beast::http;

namespace {

constexpr int kLingerSeconds = 2;
constexpr int kTurnedAway = 64;           // how many of those are spoken to at a time
constexpr std::size_t kSpill = 16384;     // bytes
constexpr std::size_t kSlowest = 100000;  // bytes a second of a client that takes a large answer

std::optional<std::string> field(const http::request<http::empty_body>& request, http::field name) {
  const auto at = request.find(name);
  if (at == request.end()) return std::nullopt;
  return std::string(at->value());
}

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(boost::asio::ip::tcp::socket socket, QueryDesk& desk, std::uint32_t address, bool stays)
      : desk_(desk), seat_(desk, address, stays), stream_(std::move(socket)) {}
  ~Connection() { desk_.answering -= answering_; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(QueryLimits::kHeader);
    parser_->body_limit(0);
    stream_.expires_after(std::chrono::seconds(QueryLimits::kReadSeconds));
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) { self->take(error); });
  }

  /// Too many are here already.
  void turn_away() {
    write({503, "text/plain; charset=utf-8", "too many connections, of all or of this address; close some\n", {}},
          false, false);
  }
  /// Its address is not let in.
  void refuse() {
    write({403, "text/plain; charset=utf-8", "this address is not among those of --osc-allow\n", {}}, false, false);
  }

 private:
  void take(beast::error_code error) {
    if (error) {
      if (const int status = status_of(error)) write({status, "text/plain", "this is no request\n", {}}, false, false);
      return;
    }
    const http::request<http::empty_body>& got = parser_->get();
    HttpRequest request;
    request.method = std::string(got.method_string());
    request.target = std::string(got.target());
    request.host = field(got, http::field::host);
    request.origin = field(got, http::field::origin);
    request.accept = field(got, http::field::accept).value_or("");
    request.keep_alive = got.keep_alive();
    const bool head = got.method() == http::verb::head;
    const bool keep = request.keep_alive;
    if (beast::websocket::is_upgrade(got)) {
      if (std::optional<HttpAnswer> stranger = refuse_stranger(request, desk_.hall.info()))
        return write(std::move(*stranger), false, false);
      return serve_web_socket(std::move(stream_), got, desk_, std::move(seat_));
    }
    stream_.expires_never();  // the hall's patience ends first
    desk_.hall.ask(std::move(request), [self = shared_from_this(), head, keep](HttpAnswer answer) {
      self->write(std::move(answer), head, keep);
    });
  }

  // what to answer to bytes that are no request; 0: nothing, nobody is there
  static int status_of(beast::error_code error) {
    if (error == http::error::end_of_stream || error == http::error::partial_message) return 0;
    if (error.category() != make_error_code(http::error::bad_method).category()) return 0;
    if (error == http::error::header_limit || error == http::error::buffer_overflow) return 431;
    return error == http::error::body_limit || error == http::error::unexpected_body ? 413 : 400;
  }

  void write(HttpAnswer answer, bool head, bool keep) {
    if (desk_.answering + answer.body.size() > QueryLimits::kAnswers)
      answer = {503, "text/plain; charset=utf-8", "too many ask for much at once; ask again\n", {}};
    response_ = {};
    response_.version(11);
    response_.result(static_cast<unsigned>(answer.status));
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    if (!answer.type.empty())
      response_.set(http::field::content_type, beast::string_view(answer.type.data(), answer.type.size()));
    if (answer.status == 405) response_.set(http::field::allow, "GET, HEAD");
    if (!answer.policy.empty()) {
      response_.set("Content-Security-Policy", answer.policy);
      response_.set("Referrer-Policy", "no-referrer");
    }
    response_.keep_alive(keep);
    response_.content_length(answer.body.size());
    if (!head) response_.body() = std::move(answer.body);
    answering_ = response_.body().size();
    desk_.answering += answering_;
    stream_.expires_after(std::chrono::seconds(QueryLimits::kWriteSeconds + answering_ / kSlowest));
    http::async_write(stream_, response_,
                      [self = shared_from_this()](beast::error_code error, std::size_t) { self->written(error); });
  }

  void written(beast::error_code error) {
    desk_.answering -= std::exchange(answering_, 0);
    response_.body().clear();
    response_.body().shrink_to_fit();
    if (error) return;
    if (response_.keep_alive()) return read();
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
    stream_.expires_after(std::chrono::seconds(kLingerSeconds));
    pour_away();
  }

  // to close while something is unread would take back the answer that is on its way
  void pour_away() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(kSpill), [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->pour_away();
    });
  }

  QueryDesk& desk_;
  Seat seat_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{QueryLimits::kHeader + QueryLimits::kFrame};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
  std::size_t answering_ = 0;
};

}  // namespace

void serve_connection(boost::asio::ip::tcp::socket socket, QueryDesk& desk) {
  boost::system::error_code error;
  const auto peer = socket.remote_endpoint(error);
  const bool known = !error && peer.address().is_v4();
  const std::uint32_t address = known ? peer.address().to_v4().to_uint() : 0;
  const bool allowed = !known || desk.hall.doors().allowed(address);
  const bool stays = allowed && !desk.full(address);
  if (!stays && desk.turned_away >= kTurnedAway) return;
  const auto connection = std::make_shared<Connection>(std::move(socket), desk, address, stays);
  if (stays) return connection->read();
  allowed ? connection->turn_away() : connection->refuse();
}

}  // namespace limber
