// One io_context on one thread. A request is answered at once, because reading a file from the disk is short.
#include "net/oscquery/site_server.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/log/log.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "net/oscquery/connection.h"
#include "net/oscquery/site_response.h"

namespace limber::oscquery {

namespace net = boost::asio;
using tcp = boost::asio::ip::tcp;
using error_code = boost::system::error_code;

struct SiteServer::Running {
  struct Context : ConnectionContext {
    explicit Context(std::string site_folder) : folder(std::move(site_folder)) {}
    // every client is on this machine
    bool is_allowed(std::uint32_t) const override { return true; }
    void handle_request(HttpRequest request, QueryHub::Respond respond) override {
      respond(respond_from_folder(request, folder));
    }

    const std::string folder;
  };

  explicit Running(std::string folder) : context(std::move(folder)) {}
  ~Running() {
    io.stop();
    if (thread.joinable()) thread.join();
  }

  error_code open(std::uint16_t port) {
    error_code error;
    const tcp::endpoint end(net::ip::address_v4::loopback(), port);
    acceptor.open(end.protocol(), error);
    if (!error) acceptor.set_option(net::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(end, error);
    if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
    return error;
  }

  void run() {
    system::name_this_thread("limber-docs");
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& e) {
        // caused by one connection; the others continue
        log_warning("docs: {}", e.what());
      }
    }
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == net::error::operation_aborted) return;
      if (!error) {
        serve_connection(std::move(socket), context);
        return accept();
      }
      // for example out of file descriptors: retry shortly
      retry_timer.expires_after(std::chrono::milliseconds(100));
      retry_timer.async_wait([this](error_code) { accept(); });
    });
  }

  Context context;
  // declared after everything that its handlers use, because its destructor destroys the handlers
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::steady_timer retry_timer{io};
  std::thread thread;
};

SiteServer::SiteServer() = default;
SiteServer::~SiteServer() { stop(); }

Result<void> SiteServer::start(const std::string& folder, std::uint16_t port) {
  if (running_ != nullptr) return {};
  std::error_code missing;
  const std::string absolute = std::filesystem::canonical(folder, missing).string();
  if (missing || !std::filesystem::is_directory(absolute, missing))
    return Error{fmt::format("{}: there is no folder of this name", printable(folder))};
  running_ = std::make_unique<Running>(absolute);
  if (const error_code error = running_->open(port)) {
    running_.reset();
    return Error{fmt::format("can't listen on 127.0.0.1:{} (TCP): {}", port, error.message())};
  }
  running_->accept();
  running_->thread = std::thread([running = running_.get()] { running->run(); });
  return {};
}

void SiteServer::stop() { running_.reset(); }

std::uint16_t SiteServer::port() const {
  error_code ignored;
  return running_ == nullptr ? std::uint16_t{0} : running_->acceptor.local_endpoint(ignored).port();
}

}  // namespace limber::oscquery
