// Values are sent from the latest value snapshot when they are due, however often they changed in between. A round
// serves one snapshot to all subscribers, in as many slices as necessary.
#include "net/osc/subscribers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::osc {

namespace {

constexpr double kDefaultRate = 60;
constexpr std::string_view kStreams = "/physics/joint/";
constexpr const char* kSubscribeUsage =
    "takes a path, a pattern or a stream (pos, rot, relrot, relpos), and a rate from 0.1 to 1000 per second";

// Returns the stream with this name or address, or nothing if the text is a path.
std::optional<StreamTarget> stream_named(std::string_view name) {
  if (name.starts_with(kStreams)) name.remove_prefix(kStreams.size());
  StreamTarget target;
  target.pos = name == "pos";
  target.rot = name == "rot";
  target.relrot = name == "relrot";
  target.relpos = name == "relpos";
  if (!target.pos && !target.rot && !target.relrot && !target.relpos) return std::nullopt;
  return target;
}

// Returns "pos" for "/physics/joint/pos" and so on; other texts unchanged.
std::string normalize_stream(const std::string& text) {
  return stream_named(text) && text.starts_with(kStreams) ? text.substr(kStreams.size()) : text;
}

}  // namespace

Subscribers::Subscribers(engine::EngineLink& link, const NetClock& clock,
                         std::function<bool(const engine::Outgoing&)> send, SendLimits per_subscriber, SendLimits total)
    : link_(link), clock_(clock), send_(std::move(send)), budget_(per_subscriber, total) {}

Subscribers::Subscriber* Subscribers::find(const CommandOrigin& origin) const {
  const auto found = std::ranges::find_if(subscribers_, [&](const auto& s) { return s->origin == origin; });
  return found == subscribers_.end() ? nullptr : found->get();
}

Result<void> Subscribers::handle_unsubscribe(const std::vector<Arg>& args, const CommandOrigin& origin) {
  if (args.size() > 1 || (args.size() == 1 && !args[0].is_text()))
    return Error{"takes a subscribed path or stream, or nothing for all"};
  const std::string path = args.empty() ? "" : normalize_stream(args[0].text);
  unsubscribe(origin, args.empty() ? nullptr : &path);
  return {};
}

Result<void> Subscribers::handle(const Message& message, const CommandOrigin& origin) {
  const std::vector<Arg>& args = message.args;
  if (message.address == "/unsubscribe") return handle_unsubscribe(args, origin);
  if (origin.source != CommandSource::osc)
    return Error{"is for UDP only; use {\"COMMAND\":\"LISTEN\",\"DATA\":path} here"};
  const bool fits =
      (args.size() == 1 || args.size() == 2) && args[0].is_text() && (args.size() == 1 || args[1].is_numeric());
  const double rate = fits && args.size() == 2 ? args[1].number : kDefaultRate;
  if (!fits || !(rate >= 0.1 && rate <= 1000)) return Error{kSubscribeUsage};
  return subscribe(origin, normalize_stream(args[0].text), rate);
}

Result<void> Subscribers::subscribe(const CommandOrigin& origin, const std::string& path, double rate) {
  std::optional<StreamTarget> stream = stream_named(path);
  if (!stream && !path.starts_with('/')) return Error{kSubscribeUsage};
  const std::int64_t now = clock_.steady();
  Subscriber* subscriber = find(origin);
  if (subscriber == nullptr) {
    if (subscribers_.size() >= kMaxSubscribers)
      return Error{fmt::format("too many subscribers; the limit is {}", kMaxSubscribers)};
    subscriber = subscribers_.emplace_back(std::make_unique<Subscriber>()).get();
    subscriber->origin = origin;
    subscriber->account = budget_.open_account();
    changed_ = true;
  }
  auto& list = subscriber->subscriptions;
  auto known = std::ranges::find_if(list, [&](const auto& s) { return s->path == path; });
  if (known == list.end()) {
    if (list.size() >= kMaxSubscriptions)
      return Error{fmt::format("too many subscriptions; the limit per sender is {}", kMaxSubscriptions)};
    known = list.insert(list.end(), std::make_unique<Subscription>());
    (*known)->path = path;
    (*known)->next_due = now;
  }
  Subscription& s = **known;
  const auto period = static_cast<std::int64_t>(1e9 / rate);
  if (!stream) subscriber->feed.add(path, period);
  changed_ = changed_ || (stream && s.period != period);
  s.period = period;
  s.next_due = std::min(s.next_due, now + period);
  s.expires_at = now + kLifetime;
  if (stream) {
    stream->rate = rate;
    s.stream = std::move(stream);
  }
  return {};
}

void Subscribers::unsubscribe(const CommandOrigin& origin, const std::string* path) {
  Subscriber* const subscriber = find(origin);
  if (subscriber == nullptr) return;
  const auto matches = [&](const auto& s) { return path == nullptr || s->path == *path; };
  for (const auto& s : subscriber->subscriptions) {
    if (matches(s) && !s->stream) subscriber->feed.remove(s->path);
  }
  std::erase_if(subscriber->subscriptions, matches);
  remove_idle();
  changed_ = true;
}

void Subscribers::expire(std::int64_t now) {
  for (const auto& subscriber : subscribers_) {
    const auto expired = [now](const auto& s) { return s->expires_at <= now; };
    if (std::ranges::none_of(subscriber->subscriptions, expired)) continue;
    changed_ = true;
    for (const auto& s : subscriber->subscriptions) {
      if (expired(s) && !s->stream) subscriber->feed.remove(s->path);
    }
    std::erase_if(subscriber->subscriptions, expired);
  }
  remove_idle();
}

void Subscribers::remove_idle() {
  std::erase_if(subscribers_, [this](const auto& subscriber) {
    if (!subscriber->subscriptions.empty()) return false;
    budget_.close_account(subscriber->account);
    return true;
  });
}

void Subscribers::work() {
  if (subscribers_.empty()) {
    in_round_ = false;
    link_.health.set(engine::HealthItem::reduced, 0);
    return;
  }
  const std::int64_t now = clock_.steady();
  expire(now);
  budget_.refill(now);
  report_throttling(now);
  if (!in_round_) begin_round();
  if (in_round_ && !continue_round(now)) return;
  if (snapshot_request_ != 0) return;
  const bool due = std::ranges::any_of(subscribers_, [now](const auto& subscriber) {
    return std::ranges::any_of(subscriber->subscriptions,
                               [now](const auto& s) { return !s->stream && s->next_due <= now; });
  });
  if (due) snapshot_request_ = link_.request_value_snapshot();
}

void Subscribers::begin_round() {
  const std::shared_ptr<const engine::ValueSnapshot> newest = link_.value_snapshots.read();
  if (newest == nullptr) return;
  const bool fresh = snapshot_request_ != 0 && newest->request >= snapshot_request_;
  if (newest->number == snapshot_number_ && !fresh) return;
  snapshot_ = newest;
  snapshot_number_ = newest->number;
  sends_values_ = fresh;
  if (fresh) snapshot_request_ = 0;
  in_round_ = true;
  served_count_ = 0;
  round_offset_++;
}

// Returns false if the slice is used up before the round is complete.
bool Subscribers::continue_round(std::int64_t now) {
  int left = kValuesPerSlice;
  for (; served_count_ < subscribers_.size(); served_count_++) {
    if (left <= 0 || !serve(*subscribers_[(round_offset_ + served_count_) % subscribers_.size()], now, left))
      return false;
  }
  in_round_ = false;
  snapshot_ = nullptr;
  return true;
}

// Returns false if there is more to do for this subscriber.
bool Subscribers::serve(Subscriber& subscriber, std::int64_t now, int& left) {
  if (!subscriber.feed.update_some(snapshot_, subscriber.origin)) return false;
  if (std::exchange(subscriber.snapshot_number, snapshot_number_) != snapshot_number_) check_paths(subscriber);
  if (!sends_values_) return true;
  for (const auto& s : subscriber.subscriptions) {
    if (s->stream || s->next_due > now) continue;
    if (left <= 0 || !send_values(subscriber, *s, left)) return false;
    s->next_due += ((now - s->next_due) / s->period + 1) * s->period;
  }
  return true;
}

// Reports paths that match no value; a matching value may appear later.
void Subscribers::check_paths(Subscriber& subscriber) {
  for (const auto& s : subscriber.subscriptions) {
    if (s->stream || std::exchange(s->checked, true)) continue;
    const std::string_view problem = subscriber.feed.problem(s->path);
    if (problem.empty()) continue;
    send_({engine::Outgoing::Destination::error, subscriber.origin,
           engine::error_message("/subscribe", fmt::format("{}; waiting for it", problem))});
  }
  if (!subscriber.feed.truncated() || std::exchange(subscriber.reported_truncated, true)) return;
  const std::string text =
      fmt::format("matches more than {} values; the others are not sent", engine::Feed::kMaxValues);
  send_({engine::Outgoing::Destination::error, subscriber.origin, engine::error_message("/subscribe", text)});
}

// Returns false if the slice is used up.
bool Subscribers::send_values(Subscriber& subscriber, const Subscription& s, int& left) {
  bool exhausted = false;
  const auto [count, complete] = subscriber.feed.send_changes(
      s.path, [&](const std::string& path, const Property& property, const engine::PropertyValue& value) {
        exhausted = left <= 0;
        if (exhausted) return false;
        engine::Outgoing out{engine::Outgoing::Destination::reply, subscriber.origin, {path, {}}};
        for (std::uint32_t i = 0; i < property.width; i++) out.message.args.push_back(Arg::of(value.numbers[i]));
        if (property.type == PropertyType::text) out.message.args.push_back(Arg::of(value.text));
        if (!send_(out)) return false;
        left--;
        return true;
      });
  left -= static_cast<int>(count / kComparisonsPerValue);
  return complete || !exhausted;
}

bool Subscribers::try_consume(const Endpoint& peer, std::size_t bytes, std::size_t datagrams) {
  Subscriber* const subscriber = find({CommandSource::osc, peer.ip, peer.port});
  return subscriber != nullptr && subscriber->account->try_consume(bytes, datagrams);
}

void Subscribers::report_throttling(std::int64_t now) {
  for (const SendBudget::Report& report : budget_.reports(now)) {
    const auto subscriber =
        std::ranges::find(subscribers_, report.account, [](const auto& each) { return each->account; });
    Message message{"/subscription/full", {}};
    if (report.throttled)
      message = {"/subscription/reduced", {Arg::of(std::round(report.values)), Arg::of(std::round(report.bytes))}};
    send_({engine::Outgoing::Destination::direct, (*subscriber)->origin, std::move(message)});
  }
  link_.health.set(engine::HealthItem::reduced, budget_.throttled());
}

std::optional<std::int64_t> Subscribers::timeout() const {
  if (in_round_) return 0;
  std::optional<std::int64_t> earliest;
  const auto consider = [&](std::int64_t at) { earliest = std::min(earliest.value_or(at), at); };
  for (const auto& subscriber : subscribers_) {
    for (const auto& s : subscriber->subscriptions) {
      consider(s->expires_at);
      if (!s->stream && snapshot_request_ == 0) consider(s->next_due);
    }
  }
  if (!subscribers_.empty()) consider(budget_.window_end());
  if (!earliest) return std::nullopt;
  return std::max<std::int64_t>(0, *earliest - clock_.steady());
}

std::vector<ResolvedTarget> Subscribers::targets() const {
  std::vector<ResolvedTarget> targets;
  for (const auto& subscriber : subscribers_) {
    for (const auto& s : subscriber->subscriptions) {
      if (!s->stream) continue;
      targets.push_back({*s->stream, {subscriber->origin.ip, subscriber->origin.port}, true});
    }
  }
  return targets;
}

std::vector<Endpoint> Subscribers::endpoints() const {
  std::vector<Endpoint> endpoints;
  for (const auto& subscriber : subscribers_) endpoints.push_back({subscriber->origin.ip, subscriber->origin.port});
  return endpoints;
}

}  // namespace limber::osc
