// Gathering: a socket that takes whole frames into memory and gives the system many of them with one call. A client
// that takes nothing for some seconds is dropped. [query]
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

namespace limber {

/// The layer below Beast's WebSocket: what that writes (answers to pings, the end) and what append() adds come out in
/// the order of the calls, each whole.
class Gathering {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;
  using error_code = boost::beast::error_code;

  explicit Gathering(boost::beast::tcp_stream&& next) : next_(std::move(next)), patience_(next_.get_executor()) {}

  /// Who must live while something is written; `seconds` is a client's time to take something.
  void keep(std::weak_ptr<void> owner, int seconds) {
    owner_ = std::move(owner);
    seconds_ = seconds;
  }
  executor_type get_executor() noexcept { return next_.get_executor(); }
  boost::beast::tcp_stream& next_layer() noexcept { return next_; }
  const boost::beast::tcp_stream& next_layer() const noexcept { return next_; }

  /// Adds bytes to what goes out soon.
  void append(std::string_view bytes) {
    pending_ += bytes;
    flush_soon();
  }
  /// Bytes that the system has not taken yet.
  std::size_t waiting() const { return pending_.size() + active_.size() - sent_; }

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
  void taken(error_code error, std::size_t size);

  boost::beast::tcp_stream next_;
  boost::asio::steady_timer patience_;
  std::weak_ptr<void> owner_;
  int seconds_ = 0;
  std::string pending_;
  std::string active_;
  std::size_t sent_ = 0;  // of active_
  bool flushing_ = false;
  error_code failed_;
};

// how Beast ends a connection of this kind
inline void teardown(boost::beast::role_type role, Gathering& stream, boost::beast::error_code& error) {
  boost::beast::websocket::teardown(role, stream.next_layer().socket(), error);
}
template <class Handler>
void async_teardown(boost::beast::role_type role, Gathering& stream, Handler&& handler) {
  boost::beast::websocket::async_teardown(role, stream.next_layer().socket(), std::forward<Handler>(handler));
}
inline void beast_close_socket(Gathering& stream) { stream.next_layer().close(); }

}  // namespace limber
