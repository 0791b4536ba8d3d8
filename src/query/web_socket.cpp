// Beast reads, answers pings and watches the time; frames out are written here, since they are four lines and many.
#include "query/web_socket.h"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "query/gathering.h"

namespace limber {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

void Gathering::flush_soon() {
  if (flushing_ || failed_) return;
  const std::shared_ptr<void> owner = owner_.lock();
  if (owner == nullptr) return;
  flushing_ = true;
  // what else is said before this comes to its turn goes with it
  net::post(get_executor(), [this, owner] { flush(); });
}

void Gathering::flush() {
  const std::shared_ptr<void> owner = owner_.lock();
  if (owner == nullptr || failed_) return;
  if (sent_ == active_.size()) {
    active_.clear();
    active_.swap(pending_);
    sent_ = 0;
  }
  if (active_.empty()) return (void)(flushing_ = false);
  patience_.expires_after(std::chrono::seconds(seconds_));
  patience_.async_wait([this, owner](error_code error) {
    // one that was set anew in the same moment is not over
    if (!error && flushing_ && patience_.expiry() <= std::chrono::steady_clock::now()) next_.close();
  });
  next_.async_write_some(net::buffer(active_.data() + sent_, active_.size() - sent_),
                         [this, owner](error_code error, std::size_t size) { taken(error, size); });
}

void Gathering::taken(error_code error, std::size_t size) {
  patience_.cancel();
  failed_ = error;
  sent_ += size;
  if (failed_) next_.close();
  flush();
}

namespace {

constexpr std::size_t kSmallFrame = 125;
constexpr std::size_t kMiddleFrame = 65535;

// RFC 6455, 5.2: the last frame of a message, not masked
std::string frame_head(bool text, std::size_t size) {
  std::string head(1, static_cast<char>(text ? 0x81 : 0x82));
  int bytes = 0;
  if (size <= kSmallFrame) {
    head += static_cast<char>(size);
  } else {
    bytes = size <= kMiddleFrame ? 2 : 8;
    head += static_cast<char>(bytes == 2 ? 126 : 127);
  }
  while (bytes-- > 0) head += static_cast<char>(size >> (8 * bytes) & 255u);
  return head;
}

class WebSocket : public ClientLine, public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(beast::tcp_stream&& stream, QueryDesk& desk, Seat seat)
      : desk_(desk), seat_(std::move(seat)), origin_(origin_of(stream)), ws_(std::move(stream)) {}
  ~WebSocket() override {
    if (client_ != nullptr) desk_.hall.leave(*client_);
  }

  void run(const beast::http::request<beast::http::empty_body>& upgrade) {
    ws_.next_layer().keep(weak_from_this(), QueryLimits::kWriteSeconds);
    beast::tcp_stream& socket = beast::get_lowest_layer(ws_);
    socket.expires_never();  // the stream above it has times of its own
    // what waits in the system is old by the time it arrives
    beast::error_code ignored;
    socket.socket().set_option(net::socket_base::send_buffer_size(QueryLimits::kSendBuffer), ignored);
    websocket::stream_base::timeout times{};
    times.handshake_timeout = std::chrono::seconds(QueryLimits::kReadSeconds);
    times.idle_timeout = std::chrono::seconds(QueryLimits::kIdleSeconds);
    times.keep_alive_pings = true;
    ws_.set_option(times);
    ws_.read_message_max(QueryLimits::kFrame);
    ws_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
      if (!error) self->enter();
    });
  }

  void send(bool text, std::string frame) override {
    if (!ws_.is_open()) return;
    // it takes less than is to be told: better none than one that lags behind
    if (waiting() + frame.size() > QueryLimits::kQueue) return beast::get_lowest_layer(ws_).close();
    ws_.next_layer().append(frame_head(text, frame.size()));
    ws_.next_layer().append(frame);
  }
  std::size_t waiting() const override { return ws_.next_layer().waiting(); }

 private:
  static Origin origin_of(beast::tcp_stream& stream) {
    beast::error_code error;
    const net::ip::tcp::endpoint peer = stream.socket().remote_endpoint(error);
    if (error || !peer.address().is_v4()) return {Hand::query, 0, 0};
    return {Hand::query, peer.address().to_v4().to_uint(), peer.port()};
  }

  void enter() {
    client_ = std::make_unique<Client>(origin_, *this, desk_.hall.doors());
    desk_.hall.enter(*client_);
    read();
  }

  void read() {
    ws_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return;  // the last to hold it lets it go
      self->take();
      self->read();
    });
  }

  void take() {
    const std::string_view frame(static_cast<const char*>(buffer_.cdata().data()), buffer_.size());
    if (!ws_.got_text()) {
      client_->binary(frame);
    } else if (client_->text(frame)) {
      desk_.hall.hurry();
    }
    buffer_.clear();
  }

  QueryDesk& desk_;
  Seat seat_;
  const Origin origin_;
  websocket::stream<Gathering, false> ws_;
  beast::flat_buffer buffer_;
  std::unique_ptr<Client> client_;
};

}  // namespace

void serve_web_socket(beast::tcp_stream stream, const beast::http::request<beast::http::empty_body>& upgrade,
                      QueryDesk& desk, Seat seat) {
  std::make_shared<WebSocket>(std::move(stream), desk, std::move(seat))->run(upgrade);
}

}  // namespace limber
