// Values are told from images: the newest when it is due, however often it changed in between.
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

Subscribers::Subscribers(EngineLink& link, const NetClock& clock, std::function<void(const Outgoing&)> send)
    : link_(link), clock_(clock), send_(std::move(send)) {}

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
    who = list_.emplace_back(std::make_unique<Subscriber>(Subscriber{origin, {}})).get();
    news_ = true;
  }
  auto& list = who->subscriptions;
  auto known = std::ranges::find_if(list, [&](const auto& s) { return s->what == what; });
  if (known == list.end()) {
    if (list.size() >= kMostEach) return Error{fmt::format("{} subscriptions are the most for one", kMostEach)};
    known = list.insert(list.end(), std::make_unique<Subscription>());
    (*known)->what = what;
    (*known)->due = now;
    if (!stream) (*known)->feed.add(what);
  }
  Subscription& s = **known;
  const auto period = static_cast<std::int64_t>(1e9 / rate);
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
  std::erase_if(who->subscriptions, [&](const auto& s) { return what == nullptr || s->what == *what; });
  std::erase_if(list_, [](const auto& s) { return s->subscriptions.empty(); });
  news_ = true;
}

void Subscribers::lapse(std::int64_t now) {
  for (const auto& who : list_) {
    const auto gone = std::erase_if(who->subscriptions, [&](const auto& s) { return s->lapses <= now; });
    news_ = news_ || gone > 0;
  }
  std::erase_if(list_, [](const auto& s) { return s->subscriptions.empty(); });
}

void Subscribers::work() {
  if (list_.empty()) return;
  const std::int64_t now = clock_.steady();
  lapse(now);
  const std::shared_ptr<const Image> image = link_.images.read();
  if (image != nullptr && image->number != heard_) hear(image);
  const bool fresh = asked_ != 0 && image != nullptr && image->asks >= asked_;
  if (fresh) asked_ = 0;
  bool due = false;
  for (const auto& who : list_) {
    for (const auto& s : who->subscriptions) {
      if (s->stream || s->due > now) continue;
      if (fresh) {
        tell(*who, *s);
        s->due += ((now - s->due) / s->period + 1) * s->period;
      } else {
        due = true;
      }
    }
  }
  if (due && asked_ == 0) asked_ = link_.ask_image();
}

void Subscribers::hear(const std::shared_ptr<const Image>& image) {
  heard_ = image->number;
  for (const auto& who : list_) {
    for (const auto& s : who->subscriptions) {
      if (s->stream) continue;
      if (!std::exchange(s->looked_at, true)) look_at(*who, *s, *image);
      s->feed.hear(image, who->origin);
    }
  }
}

// whether there is such a value; one that there is not may come yet
void Subscribers::look_at(const Subscriber& who, Subscription& s, const Image& image) {
  PatternBudget budget;
  const Result<std::vector<TreePlace>> places = image.tree->match(s.what, budget, Feed::kMostValues);
  const auto is_value = [](const TreePlace& p) { return p.row != nullptr && p.row->kind != RowKind::action; };
  if (places && std::ranges::any_of(*places, is_value)) return;
  const std::string why = !places ? places.error() : fmt::format("'{}' is no value", printable(s.what));
  send_({Outgoing::To::error, who.origin, error_message("/subscribe", fmt::format("{}; it is waited for", why))});
}

void Subscribers::tell(const Subscriber& who, Subscription& s) {
  s.feed.tell([&](const std::string& path, const Row& row, const RowValue& value) {
    Outgoing out{Outgoing::To::sender, who.origin, {path, {}}};
    for (std::uint32_t i = 0; i < row.width; i++) out.message.args.push_back(Arg::of(value.numbers[i]));
    if (row.type == RowType::text) out.message.args.push_back(Arg::of(value.text));
    send_(out);
    return true;
  });
}

std::optional<std::int64_t> Subscribers::wait() const {
  std::optional<std::int64_t> soonest;
  const auto earlier = [&](std::int64_t at) { soonest = std::min(soonest.value_or(at), at); };
  for (const auto& who : list_) {
    for (const auto& s : who->subscriptions) {
      earlier(s->lapses);
      if (!s->stream && asked_ == 0) earlier(s->due);
    }
  }
  if (!soonest) return std::nullopt;
  return std::max<std::int64_t>(0, *soonest - clock_.steady());
}

std::vector<Target> Subscribers::targets() const {
  std::vector<Target> targets;
  for (const auto& who : list_) {
    for (const auto& s : who->subscriptions) {
      if (!s->stream) continue;
      targets.push_back({*s->stream, {who->origin.ip, who->origin.port}});
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
