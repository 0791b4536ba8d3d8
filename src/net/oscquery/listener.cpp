// An exception in one connection doesn't end the others.
#include "net/oscquery/listener.h"

#include <chrono>
#include <exception>
#include <utility>

#include <boost/asio/ip/v6_only.hpp>

#include "base/log/log.h"
#include "base/system/thread.h"

namespace limber::oscquery {

namespace net = boost::asio;
using tcp = net::ip::tcp;
using error_code = boost::system::error_code;

error_code Listener::open(const tcp::endpoint& at) {
  error_code error;
  acceptor_.open(at.protocol(), error);
  if (!error) acceptor_.set_option(net::socket_base::reuse_address(true), error);
  if (!error && at.protocol() == tcp::v6()) acceptor_.set_option(net::ip::v6_only(true), error);
  if (!error) acceptor_.bind(at, error);
  if (!error) acceptor_.listen(net::socket_base::max_listen_connections, error);
  return error;
}

void Listener::start(const char* thread_name, const char* server_name) {
  accept();
  thread_ = std::thread([this, thread_name, server_name] { run(thread_name, server_name); });
}

void Listener::stop() {
  io_.stop();
  if (thread_.joinable()) thread_.join();
}

tcp::endpoint Listener::local_endpoint() const {
  error_code ignored;
  return acceptor_.local_endpoint(ignored);
}

void Listener::run(const char* thread_name, const char* server_name) {
  system::name_this_thread(thread_name);
  for (;;) {
    try {
      io_.run();
      return;
    } catch (const std::exception& e) {
      log_warning("{}: {}", server_name, e.what());
    }
  }
}

void Listener::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == net::error::operation_aborted) return;
    if (!error) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      serve_connection(std::move(socket), context_);
      return accept();
    }
    // for example out of file descriptors: retry shortly
    retry_timer_.expires_after(std::chrono::milliseconds(100));
    retry_timer_.async_wait([this](error_code) { accept(); });
  });
}

}  // namespace limber::oscquery
