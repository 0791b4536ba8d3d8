// CoalescingStream: a stream that buffers whole frames and writes many of them with one system call. It closes the
// connection if a write makes no progress for some seconds because the client doesn't read. [query]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace limber::oscquery {

/// The layer below Beast's WebSocket stream. Beast's own writes (pongs, close frames) and append() are sent in call
/// order and never interleaved.
class CoalescingStream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;
  using error_code = boost::beast::error_code;

  explicit CoalescingStream(boost::beast::tcp_stream&& next)
      : next_(std::move(next)), write_timer_(next_.get_executor()) {}

  /// Sets the owner, which is kept alive during writes, and the client's write timeout.
  void set_owner(std::weak_ptr<void> owner, int seconds) {
    owner_ = std::move(owner);
    timeout_seconds_ = seconds;
  }
  executor_type get_executor() noexcept { return next_.get_executor(); }
  boost::beast::tcp_stream& next_layer() noexcept { return next_; }
  const boost::beast::tcp_stream& next_layer() const noexcept { return next_; }

  /// Queues bytes; they are written soon.
  void append(std::string_view bytes) {
    pending_ += bytes;
    flush_soon();
  }
  /// Number of bytes not yet written to the socket.
  std::size_t unsent_bytes() const { return pending_.size() + active_.size() - sent_; }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return next_.async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    return boost::asio::async_initiate<Handler, void(error_code, std::size_t)>(
        [this, &buffers](auto&& done) {
          const std::size_t before = pending_.size();
          const std::size_t size = boost::asio::buffer_size(buffers);
          pending_.resize(before + size);
          boost::asio::buffer_copy(boost::asio::buffer(pending_.data() + before, size), buffers);
          flush_soon();
          boost::asio::post(get_executor(), boost::beast::bind_front_handler(std::forward<decltype(done)>(done),
                                                                             failed_, failed_ ? 0 : size));
        },
        handler);
  }

 private:
  void flush_soon();
  void flush();
  void on_written(error_code error, std::size_t size);

  boost::beast::tcp_stream next_;
  boost::asio::steady_timer write_timer_;
  std::weak_ptr<void> owner_;
  int timeout_seconds_ = 0;
  std::string pending_;
  std::string active_;
  std::size_t sent_ = 0;  // of active_
  bool flushing_ = false;
  error_code failed_;
};

// Beast's customization points for closing this stream.
inline void teardown(boost::beast::role_type role, CoalescingStream& stream, boost::beast::error_code& error) {
  boost::beast::websocket::teardown(role, stream.next_layer().socket(), error);
}
template <class Handler>
void async_teardown(boost::beast::role_type role, CoalescingStream& stream, Handler&& handler) {
  boost::beast::websocket::async_teardown(role, stream.next_layer().socket(), std::forward<Handler>(handler));
}
inline void beast_close_socket(CoalescingStream& stream) { stream.next_layer().close(); }

}  // namespace limber::oscquery
