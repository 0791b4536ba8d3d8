// Listener: accepts the connections of an HTTP server on one thread, which also runs the server's other handlers.
#pragma once

#include <cstdint>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/system/error_code.hpp>

#include "net/oscquery/connection.h"

namespace limber::oscquery {

class Listener {
 public:
  /// The context must outlive the listener.
  explicit Listener(ConnectionContext& context) : context_(context) {}
  ~Listener() { stop(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Binds the address; port 0: a free port.
  boost::system::error_code open(const boost::asio::ip::tcp::endpoint& at);
  /// Starts the thread. Literals: its name (at most 15 bytes), and the name of the server in warnings.
  void start(const char* thread_name, const char* server_name);
  /// Ends the thread; no handler runs after it.
  void stop();

  /// For timers and descriptors of the server, which must be destroyed before the listener.
  boost::asio::io_context& io() { return io_; }
  /// The bound address; after open().
  boost::asio::ip::tcp::endpoint local_endpoint() const;

 private:
  void run(const char* thread_name, const char* server_name);
  void accept();

  ConnectionContext& context_;
  boost::asio::io_context io_{1};
  boost::asio::ip::tcp::acceptor acceptor_{io_};
  boost::asio::steady_timer retry_timer_{io_};
  std::thread thread_;
};

}  // namespace limber::oscquery
