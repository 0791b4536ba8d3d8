// What a look-up's thread shares with the network thread lives as long as either.
#include "osc/names.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "base/system/thread.h"

namespace limber {

namespace {

constexpr std::uint32_t kThisMachine = 0x7f000001;

std::optional<Endpoint> at_once(const std::string& host, std::uint16_t port) {
  if (const std::optional<std::uint32_t> ip = parse_ipv4(host)) return Endpoint{*ip, port};
  if (host == "localhost") return Endpoint{kThisMachine, port};
  return std::nullopt;
}

}  // namespace

struct HostNames::Shared {
  std::function<void()> ring;
  std::mutex mutex;                                              // guards what follows
  std::map<std::string, std::optional<Result<Endpoint>>> found;  // by host; nothing: on its way
  bool news = false;
  std::condition_variable ended;  // a look-up
};

HostNames::HostNames(LookUp look_up, std::function<void()> ring)
    : look_up_(std::move(look_up)), shared_(std::make_shared<Shared>()) {
  shared_->ring = std::move(ring);
}

std::optional<Result<Endpoint>> HostNames::find(const std::string& host, std::uint16_t port) {
  if (const std::optional<Endpoint> at = at_once(host, port)) return *at;
  {
    const std::scoped_lock lock(shared_->mutex);
    const auto [entry, fresh] = shared_->found.try_emplace(host);
    if (!fresh) {
      if (!entry->second || !entry->second->ok()) return entry->second;
      return Endpoint{(*entry->second)->ip, port};
    }
  }
  const auto look = [host, port, look_up = look_up_, shared = shared_] {
    Result<Endpoint> at = look_up(host, port);
    {
      const std::scoped_lock lock(shared->mutex);
      shared->found[host] = std::move(at);
      shared->news = true;
    }
    shared->ended.notify_all();
    shared->ring();
  };
  if (std::thread thread; system::start_thread(thread, look)) {
    thread.detach();
  } else {
    look();  // no thread is left: this once it is waited for
  }
  return std::nullopt;
}

std::optional<Result<Endpoint>> HostNames::wait_for(const std::string& host, std::uint16_t port,
                                                    std::chrono::milliseconds limit) {
  if (std::optional<Result<Endpoint>> at = find(host, port)) return at;
  {
    std::unique_lock lock(shared_->mutex);
    shared_->ended.wait_for(lock, limit, [&] { return shared_->found[host].has_value(); });
  }
  return find(host, port);
}

bool HostNames::take_news() {
  const std::scoped_lock lock(shared_->mutex);
  return std::exchange(shared_->news, false);
}

void HostNames::forget() {
  const std::scoped_lock lock(shared_->mutex);
  std::erase_if(shared_->found, [](const auto& entry) { return entry.second.has_value(); });
}

void HostNames::forget_failed() {
  const std::scoped_lock lock(shared_->mutex);
  std::erase_if(shared_->found, [](const auto& entry) { return entry.second && !entry.second->ok(); });
}

}  // namespace limber
