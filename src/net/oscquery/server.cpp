// The listener's thread also handles wake-ups by the engine and runs the hub's timer.
#include "net/oscquery/server.h"

#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/log/log.h"
#include "base/system/process.h"
#include "base/text.h"
#include "net/oscquery/connection.h"
#include "net/oscquery/listener.h"

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
    listener.stop();
    descriptor.release();  // the Wake owns and closes it
    hub.cancel_all();      // pending requests hold connections, and their sockets need the listener's io_context
  }

  error_code open(const ListenAddress& at) {
    error_code error;
    const bool ipv6 = at.address.find(':') != std::string::npos;
    const auto found = tcp::resolver(listener.io())
                           .resolve(ipv6 ? tcp::v6() : tcp::v4(), at.address, std::to_string(at.port),
                                    tcp::resolver::numeric_service, error);
    if (error) return error;
    return listener.open(found.begin()->endpoint());
  }

  void begin() {
    descriptor.assign(wake->fd());
    wait_for_wake();
    schedule_update();
    listener.start("limber-query", "OSCQuery");
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
  Listener listener{context};
  net::posix::stream_descriptor descriptor{listener.io()};
  net::steady_timer timer{listener.io()};
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
    return Error{fmt::format("OSCQuery can't listen on {} (TCP): {}. {}",
                             system::host_port_text(printable(at.address), at.port), error.message(), kListenHint)};
  }
  if (running_->listener.local_endpoint().address().is_unspecified())
    log_warning("OSCQuery {}: open to the network, every client is accepted. Restrict it with --osc-allow CIDR",
                system::host_port_text(at.address, port()));
  running_->begin();
  return {};
}

void QueryServer::stop() { running_.reset(); }

std::uint16_t QueryServer::port() const {
  return running_ == nullptr ? std::uint16_t{0} : running_->listener.local_endpoint().port();
}

}  // namespace limber::oscquery
