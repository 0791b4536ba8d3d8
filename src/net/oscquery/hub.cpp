// Value snapshots are requested asynchronously; nothing here blocks.
#include "net/oscquery/hub.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "net/oscquery/path_events.h"

namespace limber::oscquery {

namespace {

HttpResponse too_busy(const char* reason) {
  return {503, "text/plain; charset=utf-8", fmt::format("{}\n", reason), {}};
}

}  // namespace

QueryHub::QueryHub(engine::EngineLink& link, QueryHost host, std::vector<std::string> names, double (*now)())
    : link_(link), host_(std::move(host)), names_(std::move(names)), now_(now) {}

HostInfo QueryHub::info() const { return {names_, host_.osc_port()}; }

void QueryHub::handle_request(HttpRequest request, Respond respond) {
  if (std::optional<HttpResponse> known = respond_without_tree(request, info())) return respond(std::move(*known));
  if (waiting_requests_.size() >= kMaxRequests) return respond(too_busy("too many requests at once; try again"));
  waiting_requests_.push_back({std::move(request), std::move(respond), link_.request_value_snapshot(), now_()});
}

void QueryHub::add_client(QueryClient& client) {
  clients_.push_back(&client);
  request_values();
}

void QueryHub::remove_client(const QueryClient& client) { std::erase(clients_, &client); }

void QueryHub::request_values() {
  // a request is pending: coalesce all further ones into one that follows it
  if (clients_snapshot_request_ != 0) return (void)(request_again_ = true);
  clients_snapshot_request_ = link_.request_value_snapshot();
  last_request_ = now_();
}

void QueryHub::on_link_event() {
  send_replies();
  const std::shared_ptr<const engine::ValueSnapshot> snapshot = link_.value_snapshots.read();
  if (snapshot == nullptr) return;
  respond_waiting(snapshot);
  if (clients_snapshot_request_ == 0 || snapshot->request < clients_snapshot_request_) return;
  clients_snapshot_request_ = 0;
  update_clients(snapshot);
  if (std::exchange(request_again_, false)) request_values();
}

void QueryHub::update_clients(const std::shared_ptr<const engine::ValueSnapshot>& snapshot) {
  std::vector<std::string> events;
  if (snapshot_ != nullptr && snapshot_->tree != snapshot->tree)
    events = path_events_between(*snapshot_->tree, *snapshot->tree);
  snapshot_ = snapshot;
  // a client may be removed while a snapshot is delivered to it
  for (QueryClient* const client : std::vector<QueryClient*>(clients_)) {
    if (std::find(clients_.begin(), clients_.end(), client) != clients_.end()) client->on_snapshot(snapshot, events);
  }
}

void QueryHub::respond_waiting(const std::shared_ptr<const engine::ValueSnapshot>& snapshot) {
  std::vector<WaitingRequest> ready;
  std::erase_if(waiting_requests_, [&](WaitingRequest& w) {
    if (snapshot->request < w.snapshot_request) return false;
    ready.push_back(std::move(w));
    return true;
  });
  std::size_t bytes = 0;
  for (const WaitingRequest& waiting : ready) {
    if (bytes > kMaxResponseBytes) {
      waiting.respond(too_busy("too many large responses at once; try again"));
      continue;
    }
    HttpResponse response = respond_from_tree(waiting.request, *snapshot);
    bytes += response.body.size();
    waiting.respond(std::move(response));
  }
}

void QueryHub::update() {
  const double now = now_();
  const bool listening =
      std::any_of(clients_.begin(), clients_.end(), [](const QueryClient* c) { return c->is_listening(); });
  // half a tick of tolerance, because timers are inexact
  const double interval = listening ? kUpdateInterval / 2 : kIdleInterval - kUpdateInterval / 2;
  if (!clients_.empty() && clients_snapshot_request_ == 0 && now - last_request_ >= interval) request_values();
  for (QueryClient* const client : std::vector<QueryClient*>(clients_)) {
    if (std::find(clients_.begin(), clients_.end(), client) != clients_.end()) client->send_log();
  }
  // answer requests that have waited for kRequestTimeout from the latest snapshot, or with 503 if there is none
  std::vector<WaitingRequest> expired;
  std::erase_if(waiting_requests_, [&](WaitingRequest& w) {
    if (now - w.since < kRequestTimeout) return false;
    expired.push_back(std::move(w));
    return true;
  });
  const std::shared_ptr<const engine::ValueSnapshot> snapshot = link_.value_snapshots.read();
  for (const WaitingRequest& waiting : expired) {
    waiting.respond(snapshot != nullptr ? respond_from_tree(waiting.request, *snapshot)
                                        : too_busy("the simulation is busy; try again"));
  }
}

void QueryHub::send_replies() {
  link_.query_output_queue.drain(replies_);
  for (const engine::Outgoing& out : replies_) {
    const auto to = std::ranges::find_if(clients_, [&](const QueryClient* c) { return c->origin() == out.origin; });
    if (to != clients_.end()) (*to)->send_reply(out, now_());
  }
}

}  // namespace limber::oscquery
