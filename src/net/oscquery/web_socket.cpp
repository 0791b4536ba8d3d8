// Beast parses input, answers pings and handles timeouts. Outgoing frames are encoded here, because they are simple and
// frequent.
#include "net/oscquery/web_socket.h"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "net/oscquery/coalescing_stream.h"

namespace limber::oscquery {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

void CoalescingStream::flush_soon() {
  if (flushing_ || failed_) return;
  const std::shared_ptr<void> owner = owner_.lock();
  if (owner == nullptr) return;
  flushing_ = true;
  // frames queued before this handler runs are sent by the same write
  net::post(get_executor(), [this, owner] { flush(); });
}

void CoalescingStream::flush() {
  const std::shared_ptr<void> owner = owner_.lock();
  if (owner == nullptr || failed_) return;
  if (sent_ == active_.size()) {
    active_.clear();
    active_.swap(pending_);
    sent_ = 0;
  }
  if (active_.empty()) return (void)(flushing_ = false);
  write_timer_.expires_after(std::chrono::seconds(timeout_seconds_));
  write_timer_.async_wait([this, owner](error_code error) {
    // ignores a timeout that fired just before the timer was restarted
    if (!error && flushing_ && write_timer_.expiry() <= std::chrono::steady_clock::now()) next_.close();
  });
  next_.async_write_some(net::buffer(active_.data() + sent_, active_.size() - sent_),
                         [this, owner](error_code error, std::size_t size) { on_written(error, size); });
}

void CoalescingStream::on_written(error_code error, std::size_t size) {
  write_timer_.cancel();
  failed_ = error;
  sent_ += size;
  if (failed_) next_.close();
  flush();
}

namespace {

constexpr std::size_t kSmallFrame = 125;
constexpr std::size_t kMediumFrame = 65535;

// RFC 6455, section 5.2: header of a message's final frame, unmasked.
std::string frame_head(bool text, std::size_t size) {
  std::string head(1, static_cast<char>(text ? 0x81 : 0x82));
  int bytes = 0;
  if (size <= kSmallFrame) {
    head += static_cast<char>(size);
  } else {
    bytes = size <= kMediumFrame ? 2 : 8;
    head += static_cast<char>(bytes == 2 ? 126 : 127);
  }
  while (bytes-- > 0) head += static_cast<char>(size >> (8 * bytes) & 255u);
  return head;
}

class WebSocket : public ClientSink, public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(beast::tcp_stream&& stream, QueryContext& context, ConnectionSlot slot)
      : context_(context), slot_(std::move(slot)), origin_(origin_of(stream)), ws_(std::move(stream)) {}
  ~WebSocket() override {
    if (client_ != nullptr) context_.hub.remove_client(*client_);
  }

  void run(const beast::http::request<beast::http::empty_body>& upgrade) {
    ws_.next_layer().set_owner(weak_from_this(), QueryLimits::kWriteSeconds);
    beast::tcp_stream& socket = beast::get_lowest_layer(ws_);
    socket.expires_never();  // the WebSocket stream has its own timeouts
    // a small send buffer, because values queued in the system are outdated when they arrive
    beast::error_code ignored;
    socket.socket().set_option(net::socket_base::send_buffer_size(QueryLimits::kSendBuffer), ignored);
    websocket::stream_base::timeout times{};
    times.handshake_timeout = std::chrono::seconds(QueryLimits::kReadSeconds);
    times.idle_timeout = std::chrono::seconds(QueryLimits::kIdleSeconds);
    times.keep_alive_pings = true;
    ws_.set_option(times);
    ws_.read_message_max(QueryLimits::kFrame);
    ws_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
      if (!error) self->start();
    });
  }

  void send(bool text, std::string frame) override {
    if (!ws_.is_open()) return;
    // the client is too slow: closing is better than an ever increasing delay
    if (queued_bytes() + frame.size() > QueryLimits::kQueue) return beast::get_lowest_layer(ws_).close();
    ws_.next_layer().append(frame_head(text, frame.size()));
    ws_.next_layer().append(frame);
  }
  std::size_t queued_bytes() const override { return ws_.next_layer().unsent_bytes(); }

 private:
  static CommandOrigin origin_of(beast::tcp_stream& stream) {
    beast::error_code error;
    const net::ip::tcp::endpoint peer = stream.socket().remote_endpoint(error);
    if (error || !peer.address().is_v4()) return {CommandSource::oscquery, 0, 0};
    return {CommandSource::oscquery, peer.address().to_v4().to_uint(), peer.port()};
  }

  void start() {
    client_ = std::make_unique<QueryClient>(origin_, *this, context_.hub.host());
    context_.hub.add_client(*client_);
    read();
  }

  void read() {
    ws_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return;  // the last reference to this object is released
      self->handle_frame();
      self->read();
    });
  }

  void handle_frame() {
    const std::string_view frame(static_cast<const char*>(buffer_.cdata().data()), buffer_.size());
    if (!ws_.got_text()) {
      client_->on_binary(frame);
    } else if (client_->on_text(frame)) {
      context_.hub.request_values();
    }
    buffer_.clear();
  }

  QueryContext& context_;
  ConnectionSlot slot_;
  const CommandOrigin origin_;
  websocket::stream<CoalescingStream, false> ws_;
  beast::flat_buffer buffer_;
  std::unique_ptr<QueryClient> client_;
};

}  // namespace

void serve_web_socket(beast::tcp_stream stream, const beast::http::request<beast::http::empty_body>& upgrade,
                      QueryContext& context, ConnectionSlot slot) {
  std::make_shared<WebSocket>(std::move(stream), context, std::move(slot))->run(upgrade);
}

}  // namespace limber::oscquery
