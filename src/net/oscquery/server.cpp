// One io_context on one thread: accepts connections, handles wake-ups by the engine, and runs the hub's timer.
#include "net/oscquery/server.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/log/log.h"
#include "base/system/process.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "net/oscquery/connection.h"

namespace limber::oscquery {

namespace net = boost::asio;
using tcp = boost::asio::ip::tcp;
using error_code = boost::system::error_code;

namespace {

constexpr const char* kListenHint =
    "Choose another port with --query [ADDR:]PORT, or continue without it with --query off or --osc-optional";

// Names by which other machines on the network may address this one, and the configured ones.
std::vector<std::string> own_names(const QueryHost& host) {
  std::vector<std::string> names = host.names;
  const std::string name = system::host_name();
  if (!name.empty()) names.insert(names.end(), {name, fmt::format("{}.local", name)});
  return names;
}

}  // namespace

struct QueryServer::Running {
  Running(engine::EngineLink& link, const QueryHost& host, const std::shared_ptr<system::Wake>& engine_wake)
      : wake(engine_wake), hub(link, host, own_names(host)) {}
  ~Running() {
    io.stop();
    if (thread.joinable()) thread.join();
    descriptor.release();  // the Wake owns and closes it
    hub.cancel_all();      // pending requests hold connections, and their sockets need `io`
  }

  error_code open(const ListenAddress& at) {
    error_code error;
    const auto found = tcp::resolver(io).resolve(tcp::v4(), at.address, std::to_string(at.port),
                                                 tcp::resolver::numeric_service, error);
    if (error) return error;
    const tcp::endpoint end = found.begin()->endpoint();
    acceptor.open(end.protocol(), error);
    if (!error) acceptor.set_option(net::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(end, error);
    if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
    return error;
  }

  void begin() {
    descriptor.assign(wake->fd());
    accept();
    wait_for_wake();
    schedule_update();
    thread = std::thread([this] { run(); });
  }

  void run() {
    system::name_this_thread("limber-query");
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& e) {
        // caused by one connection; the others continue
        log_warning("OSCQuery: {}", e.what());
      }
    }
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == net::error::operation_aborted) return;
      if (!error) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        serve_connection(std::move(socket), context);
        return accept();
      }
      // for example out of file descriptors: retry shortly
      retry_timer.expires_after(std::chrono::milliseconds(100));
      retry_timer.async_wait([this](error_code) { accept(); });
    });
  }

  void wait_for_wake() {
    descriptor.async_wait(net::posix::stream_descriptor::wait_read, [this](error_code error) {
      if (error) return;
      wake->clear();
      hub.on_link_event();
      wait_for_wake();
    });
  }

  void schedule_update() {
    timer.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(QueryHub::kUpdateInterval)));
    timer.async_wait([this](error_code error) {
      if (error) return;
      if (hub.busy()) hub.update();
      schedule_update();
    });
  }

  const std::shared_ptr<system::Wake> wake;
  QueryHub hub;
  QueryContext context{hub};
  // declared after everything that its handlers use, because its destructor destroys the handlers
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::posix::stream_descriptor descriptor{io};
  net::steady_timer timer{io};
  net::steady_timer retry_timer{io};
  std::thread thread;
};

QueryServer::QueryServer(engine::EngineLink& link, QueryHost host)
    : link_(link), host_(std::move(host)), wake_(std::make_shared<system::Wake>()) {
  link_.wake_query = [wake = wake_] { wake->notify(); };
}

QueryServer::~QueryServer() { stop(); }

Result<void> QueryServer::start(const ListenAddress& at) {
  if (running_ != nullptr) return {};
  running_ = std::make_unique<Running>(link_, host_, wake_);
  if (const error_code error = running_->open(at)) {
    running_.reset();
    return Error{fmt::format("OSCQuery can't listen on {}:{} (TCP): {}. {}", printable(at.address), at.port,
                             error.message(), kListenHint)};
  }
  error_code ignored;
  if (running_->acceptor.local_endpoint(ignored).address().is_unspecified())
    log_warning("OSCQuery {}:{}: open to the network, every client is accepted. Restrict it with --osc-allow CIDR",
                at.address, port());
  running_->begin();
  return {};
}

void QueryServer::stop() { running_.reset(); }

std::uint16_t QueryServer::port() const {
  error_code ignored;
  return running_ == nullptr ? std::uint16_t{0} : running_->acceptor.local_endpoint(ignored).port();
}

}  // namespace limber::oscquery
