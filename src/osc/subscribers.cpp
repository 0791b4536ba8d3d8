// Values are told from images: the newest when it is due, however often it changed in between. A round serves one image
// to all subscribers, in as many slices as that takes.
#include "osc/subscribers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

constexpr double kUsualRate = 60;
constexpr std::string_view kStreams = "/physics/joint/";
constexpr const char* kForm =
    "takes a path, a pattern or a stream (pos, rot, relrot, relpos), and how often a second: 0.1 to 1000";

// the stream that is meant, or nothing: then it is a path
std::optional<StreamTarget> stream_named(std::string_view what) {
  if (what.starts_with(kStreams)) what.remove_prefix(kStreams.size());
  StreamTarget target;
  target.pos = what == "pos";
  target.rot = what == "rot";
  target.relrot = what == "relrot";
  target.relpos = what == "relpos";
  if (!target.pos && !target.rot && !target.relrot && !target.relpos) return std::nullopt;
  return target;
}

// "/physics/joint/pos" as "pos"; anything else as it is
std::string plain_stream(const std::string& what) {
  return stream_named(what) && what.starts_with(kStreams) ? what.substr(kStreams.size()) : what;
}

}  // namespace

Subscribers::Subscribers(EngineLink& link, const NetClock& clock, std::function<bool(const Outgoing&)> send,
                         SendLimits each, SendLimits all)
    : link_(link), clock_(clock), send_(std::move(send)), budget_(each, all) {}

Subscribers::Subscriber* Subscribers::find(const Origin& origin) const {
  const auto found = std::ranges::find_if(list_, [&](const auto& s) { return s->origin == origin; });
  return found == list_.end() ? nullptr : found->get();
}

Result<void> Subscribers::take(const Message& message, const Origin& origin) {
  const std::vector<Arg>& args = message.args;
  if (message.address == "/unsubscribe") {
    if (args.size() > 1 || (args.size() == 1 && !args[0].is_text()))
      return Error{"takes the path or stream that was subscribed to, or nothing: all"};
    const std::string what = args.empty() ? "" : plain_stream(args[0].text);
    unsubscribe(origin, args.empty() ? nullptr : &what);
    return {};
  }
  if (origin.hand != Hand::osc)
    return Error{"is for senders by UDP; here it is {\"COMMAND\":\"LISTEN\",\"DATA\":path}"};
  const bool fits =
      (args.size() == 1 || args.size() == 2) && args[0].is_text() && (args.size() == 1 || args[1].is_numeric());
  const double rate = fits && args.size() == 2 ? args[1].number : kUsualRate;
  if (!fits || !(rate >= 0.1 && rate <= 1000)) return Error{kForm};
  return subscribe(origin, plain_stream(args[0].text), rate);
}

Result<void> Subscribers::subscribe(const Origin& origin, const std::string& what, double rate) {
  std::optional<StreamTarget> stream = stream_named(what);
  if (!stream && !what.starts_with('/')) return Error{kForm};
  const std::int64_t now = clock_.steady();
  Subscriber* who = find(origin);
  if (who == nullptr) {
    if (list_.size() >= kMost) return Error{fmt::format("{} have subscribed already; no more can", kMost)};
    who = list_.emplace_back(std::make_unique<Subscriber>()).get();
    who->origin = origin;
    who->account = budget_.open();
    news_ = true;
  }
  auto& list = who->subscriptions;
  auto known = std::ranges::find_if(list, [&](const auto& s) { return s->what == what; });
  if (known == list.end()) {
    if (list.size() >= kMostEach) return Error{fmt::format("{} subscriptions are the most for one", kMostEach)};
    known = list.insert(list.end(), std::make_unique<Subscription>());
    (*known)->what = what;
    (*known)->due = now;
  }
  Subscription& s = **known;
  const auto period = static_cast<std::int64_t>(1e9 / rate);
  if (!stream) who->feed.add(what, period);
  news_ = news_ || (stream && s.period != period);
  s.period = period;
  s.due = std::min(s.due, now + period);
  s.lapses = now + kLasts;
  if (stream) {
    stream->rate = rate;
    s.stream = std::move(stream);
  }
  return {};
}

void Subscribers::unsubscribe(const Origin& origin, const std::string* what) {
  Subscriber* const who = find(origin);
  if (who == nullptr) return;
  const auto gone = [&](const auto& s) { return what == nullptr || s->what == *what; };
  for (const auto& s : who->subscriptions) {
    if (gone(s) && !s->stream) who->feed.remove(s->what);
  }
  std::erase_if(who->subscriptions, gone);
  forget_idle();
  news_ = true;
}

void Subscribers::lapse(std::int64_t now) {
  for (const auto& who : list_) {
    const auto lapsed = [now](const auto& s) { return s->lapses <= now; };
    if (std::ranges::none_of(who->subscriptions, lapsed)) continue;
    news_ = true;
    for (const auto& s : who->subscriptions) {
      if (lapsed(s) && !s->stream) who->feed.remove(s->what);
    }
    std::erase_if(who->subscriptions, lapsed);
  }
  forget_idle();
}

void Subscribers::forget_idle() {
  std::erase_if(list_, [this](const auto& who) {
    if (!who->subscriptions.empty()) return false;
    budget_.close(who->account);
    return true;
  });
}

void Subscribers::work() {
  if (list_.empty()) {
    in_round_ = false;
    link_.health.set(HealthItem::reduced, 0);
    return;
  }
  const std::int64_t now = clock_.steady();
  lapse(now);
  budget_.refill(now);
  report(now);
  if (!in_round_) begin_round();
  if (in_round_ && !go_round(now)) return;
  if (asked_ != 0) return;
  const bool due = std::ranges::any_of(list_, [now](const auto& who) {
    return std::ranges::any_of(who->subscriptions, [now](const auto& s) { return !s->stream && s->due <= now; });
  });
  if (due) asked_ = link_.ask_image();
}

void Subscribers::begin_round() {
  const std::shared_ptr<const Image> newest = link_.images.read();
  if (newest == nullptr) return;
  const bool fresh = asked_ != 0 && newest->asks >= asked_;
  if (newest->number == heard_ && !fresh) return;
  image_ = newest;
  heard_ = newest->number;
  tells_ = fresh;
  if (fresh) asked_ = 0;
  in_round_ = true;
  served_ = 0;
  first_++;
}

// false: there is more to be done
bool Subscribers::go_round(std::int64_t now) {
  int left = kSlice;
  for (; served_ < list_.size(); served_++) {
    if (left <= 0 || !serve(*list_[(first_ + served_) % list_.size()], now, left)) return false;
  }
  in_round_ = false;
  image_ = nullptr;
  return true;
}

// false: there is more to be done for this one
bool Subscribers::serve(Subscriber& who, std::int64_t now, int& left) {
  if (!who.feed.hear_some(image_, who.origin)) return false;
  if (std::exchange(who.heard, heard_) != heard_) look_at(who);
  if (!tells_) return true;
  for (const auto& s : who.subscriptions) {
    if (s->stream || s->due > now) continue;
    if (left <= 0 || !tell(who, *s, left)) return false;
    s->due += ((now - s->due) / s->period + 1) * s->period;
  }
  return true;
}

// whether there are such values; those that there are not may come yet
void Subscribers::look_at(Subscriber& who) {
  for (const auto& s : who.subscriptions) {
    if (s->stream || std::exchange(s->looked_at, true)) continue;
    const std::string_view problem = who.feed.problem(s->what);
    if (problem.empty()) continue;
    send_({Outgoing::To::error, who.origin, error_message("/subscribe", fmt::format("{}; it is waited for", problem))});
  }
  if (!who.feed.truncated() || std::exchange(who.said_truncated, true)) return;
  const std::string text = fmt::format("reaches more than {} values; the others are not sent", Feed::kMostValues);
  send_({Outgoing::To::error, who.origin, error_message("/subscribe", text)});
}

// false: the slice is over
bool Subscribers::tell(Subscriber& who, const Subscription& s, int& left) {
  bool over = false;
  const auto [count, all] = who.feed.tell(s.what, [&](const std::string& path, const Row& row, const RowValue& value) {
    over = left <= 0;
    if (over) return false;
    Outgoing out{Outgoing::To::sender, who.origin, {path, {}}};
    for (std::uint32_t i = 0; i < row.width; i++) out.message.args.push_back(Arg::of(value.numbers[i]));
    if (row.type == RowType::text) out.message.args.push_back(Arg::of(value.text));
    if (!send_(out)) return false;
    left--;
    return true;
  });
  left -= static_cast<int>(count / kComparedForOne);
  return all || !over;
}

bool Subscribers::spend(const Endpoint& end, std::size_t bytes, std::size_t datagrams) {
  Subscriber* const who = find({Hand::osc, end.ip, end.port});
  return who != nullptr && who->account->spend(bytes, datagrams);
}

void Subscribers::report(std::int64_t now) {
  for (const SendBudget::Report& report : budget_.reports(now)) {
    const auto who = std::ranges::find(list_, report.account, [](const auto& each) { return each->account; });
    Message message{"/subscription/full", {}};
    if (report.reduced)
      message = {"/subscription/reduced", {Arg::of(std::round(report.values)), Arg::of(std::round(report.bytes))}};
    send_({Outgoing::To::direct, (*who)->origin, std::move(message)});
  }
  link_.health.set(HealthItem::reduced, budget_.reduced());
}

std::optional<std::int64_t> Subscribers::wait() const {
  if (in_round_) return 0;
  std::optional<std::int64_t> soonest;
  const auto earlier = [&](std::int64_t at) { soonest = std::min(soonest.value_or(at), at); };
  for (const auto& who : list_) {
    for (const auto& s : who->subscriptions) {
      earlier(s->lapses);
      if (!s->stream && asked_ == 0) earlier(s->due);
    }
  }
  if (!list_.empty()) earlier(budget_.window_end());
  if (!soonest) return std::nullopt;
  return std::max<std::int64_t>(0, *soonest - clock_.steady());
}

std::vector<Target> Subscribers::targets() const {
  std::vector<Target> targets;
  for (const auto& who : list_) {
    for (const auto& s : who->subscriptions) {
      if (!s->stream) continue;
      targets.push_back({*s->stream, {who->origin.ip, who->origin.port}, true});
    }
  }
  return targets;
}

std::vector<Endpoint> Subscribers::ends() const {
  std::vector<Endpoint> ends;
  for (const auto& who : list_) ends.push_back({who->origin.ip, who->origin.port});
  return ends;
}

}  // namespace limber
