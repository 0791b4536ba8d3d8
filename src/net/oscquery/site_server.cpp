// A request is answered at once, because reading a file from the disk is short.
#include "net/oscquery/site_server.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <boost/asio/ip/tcp.hpp>

#include "base/text.h"
#include "net/oscquery/connection.h"
#include "net/oscquery/listener.h"
#include "net/oscquery/site_response.h"

namespace limber::oscquery {

struct SiteServer::Running {
  struct Context : ConnectionContext {
    explicit Context(std::string site_folder) : folder(std::move(site_folder)) {}
    // every client is on this machine
    bool is_allowed(const system::IpAddress&) const override { return true; }
    void handle_request(HttpRequest request, QueryHub::Respond respond) override {
      respond(respond_from_folder(request, folder));
    }

    const std::string folder;
  };

  explicit Running(std::string folder) : context(std::move(folder)) {}

  Context context;
  Listener listener{context};
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
  const boost::asio::ip::tcp::endpoint at(boost::asio::ip::address_v4::loopback(), port);
  if (const boost::system::error_code error = running_->listener.open(at)) {
    running_.reset();
    return Error{fmt::format("can't listen on 127.0.0.1:{} (TCP): {}", port, error.message())};
  }
  running_->listener.start("limber-docs", "docs");
  return {};
}

void SiteServer::stop() { running_.reset(); }

std::uint16_t SiteServer::port() const {
  return running_ == nullptr ? std::uint16_t{0} : running_->listener.local_endpoint().port();
}

}  // namespace limber::oscquery
