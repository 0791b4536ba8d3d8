// One io_context on one thread: accepting, the engine's bell, the beat.
#include "query/server.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/log.h"
#include "base/system/process.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "query/connection.h"

namespace limber {

namespace net = boost::asio;
using tcp = boost::asio::ip::tcp;
using error_code = boost::system::error_code;

namespace {

constexpr const char* kCure =
    "choose another with --query [ADDR:]PORT, or play without with --query off or --osc-optional";

// as a machine beside this one may call it; and further names
std::vector<std::string> own_names(const QueryDoors& doors) {
  std::vector<std::string> names = doors.names;
  const std::string name = system::host_name();
  if (!name.empty()) names.insert(names.end(), {name, fmt::format("{}.local", name)});
  return names;
}

}  // namespace

struct QueryServer::Running {
  Running(EngineLink& link, const QueryDoors& doors, const std::shared_ptr<system::Wake>& bell)
      : wake(bell), hall(link, doors, own_names(doors)) {}
  ~Running() {
    io.stop();
    if (thread.joinable()) thread.join();
    descriptor.release();  // the bell's, who closes it
    hall.dismiss();        // connections that wait: their sockets need `io`
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
    listen_for_bell();
    beat();
    thread = std::thread([this] { run(); });
  }

  void run() {
    system::name_this_thread("limber-query");
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& e) {
        // one connection's; the others go on
        log_warning("the query server: {}", e.what());
      }
    }
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == net::error::operation_aborted) return;
      if (!error) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        serve_connection(std::move(socket), desk);
        return accept();
      }
      // out of descriptors, say: better in a moment
      pause.expires_after(std::chrono::milliseconds(100));
      pause.async_wait([this](error_code) { accept(); });
    });
  }

  void listen_for_bell() {
    descriptor.async_wait(net::posix::stream_descriptor::wait_read, [this](error_code error) {
      if (error) return;
      wake->clear();
      hall.bell();
      listen_for_bell();
    });
  }

  void beat() {
    timer.expires_after(
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(Hall::kBeat)));
    timer.async_wait([this](error_code error) {
      if (error) return;
      if (hall.busy()) hall.beat();
      beat();
    });
  }

  const std::shared_ptr<system::Wake> wake;
  Hall hall;
  QueryDesk desk{hall};
  // behind what its handlers use: it takes them along when it goes
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::posix::stream_descriptor descriptor{io};
  net::steady_timer timer{io};
  net::steady_timer pause{io};
  std::thread thread;
};

QueryServer::QueryServer(EngineLink& link, QueryDoors doors)
    : link_(link), doors_(std::move(doors)), wake_(std::make_shared<system::Wake>()) {
  link_.wake_query = [wake = wake_] { wake->notify(); };
}

QueryServer::~QueryServer() { stop(); }

Result<void> QueryServer::start(const ListenAddress& at) {
  if (running_ != nullptr) return {};
  running_ = std::make_unique<Running>(link_, doors_, wake_);
  if (const error_code error = running_->open(at)) {
    running_.reset();
    return Error{fmt::format("OSCQuery can't listen on {}:{} (TCP): {}; {}", printable(at.address), at.port,
                             error.message(), kCure)};
  }
  error_code ignored;
  if (running_->acceptor.local_endpoint(ignored).address().is_unspecified())
    log_warning("OSCQuery {}:{}: open to the network, everyone may look and play; --osc-allow CIDR limits it",
                at.address, port());
  running_->begin();
  return {};
}

void QueryServer::stop() { running_.reset(); }

std::uint16_t QueryServer::port() const {
  error_code ignored;
  return running_ == nullptr ? std::uint16_t{0} : running_->acceptor.local_endpoint(ignored).port();
}

}  // namespace limber
