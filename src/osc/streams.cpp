// One snapshot is read per round, so that all targets that are due in it show the same tick.
#include "osc/streams.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/log.h"
#include "base/system/udp_socket.h"
#include "base/text.h"
#include "osc/tap.h"

namespace limber {

namespace {

std::int64_t period_of(const StreamTarget& wish) {
  return static_cast<std::int64_t>(1e9 / std::clamp(wish.rate, 0.1, 1000.0));
}

bool wants_streams(const StreamTarget& wish) { return wish.pos || wish.rot || wish.relrot || wish.relpos; }

}  // namespace

Streams::Streams(EngineLink& link, const LiveOffsets& offsets, const NetClock& clock, SendGate may_serve)
    : link_(link), offsets_(offsets), clock_(clock), may_serve_(std::move(may_serve)) {}

void Streams::set_targets(const std::vector<Target>& targets) {
  std::vector<std::unique_ptr<Stream>> streams;
  for (const Target& target : targets) {
    if (!wants_streams(target.wish)) continue;
    const auto old = std::ranges::find_if(streams_, [&](const auto& s) { return s && s->target == target; });
    streams.push_back(old != streams_.end() ? std::move(*old)
                                            : std::make_unique<Stream>(target, offsets_, clock_.steady()));
  }
  streams_ = std::move(streams);
}

void Streams::send_due(system::UdpSender& sender) {
  const std::int64_t now = clock_.steady();
  std::shared_ptr<const Snapshot> snapshot;
  const std::size_t begin = next_;
  std::size_t served = 0;  // bytes to subscribers
  for (std::size_t i = 0; i < streams_.size(); i++) {
    Stream& stream = *streams_[(begin + i) % streams_.size()];
    if (stream.due > now || (stream.target.subscribed && served >= kSlice)) continue;
    const std::int64_t period = period_of(stream.target.wish);
    stream.due += ((now - stream.due) / period + 1) * period;
    if (!snapshot) snapshot = link_.snapshots.read();
    if (!snapshot) continue;
    const std::size_t bytes = send_frame(sender, stream, *snapshot);
    if (!stream.target.subscribed) continue;
    served += bytes;
    if (served >= kSlice) next_ = (begin + i + 1) % streams_.size();
  }
}

// how many bytes went out
std::size_t Streams::send_frame(system::UdpSender& sender, Stream& stream, const Snapshot& snapshot) {
  stream.frame.lay_out(snapshot.roster, stream.target.wish);
  if (!stream.frame.too_large().empty() && stream.said_too_large != snapshot.roster) {
    stream.said_too_large = snapshot.roster;
    log_warning("OSC out: body '{}' has too many joints for one message and is not streamed",
                printable(stream.frame.too_large().front()));
  }
  const std::size_t bytes = stream.frame.bytes().size();
  if (stream.target.subscribed && !may_serve_(stream.target.at, bytes, stream.frame.datagram_sizes().size())) return 0;
  stream.frame.fill(snapshot);
  const system::BatchResult result =
      sender.send(stream.target.at, stream.frame.bytes(), stream.frame.datagram_sizes(), stream.segmentation);
  link_.counters.sent.fetch_add(result.sent, std::memory_order_relaxed);
  if (link_.traffic.watched()) note_frame(stream, result.sent);
  if (result.error == 0) return bytes;
  link_.counters.unsent.fetch_add(stream.frame.datagram_sizes().size() - result.sent, std::memory_order_relaxed);
  if (const auto more = lost_.ask(clock_.steady())) {
    log_warning("OSC out to {}: {} of {} datagrams of a frame not sent: {}; fewer streams, bodies or frames help{}",
                endpoint_text(stream.target.at), stream.frame.datagram_sizes().size() - result.sent,
                stream.frame.datagram_sizes().size(), std::generic_category().message(result.error), *more);
  }
  return bytes;
}

void Streams::note_frame(const Stream& stream, std::size_t datagrams) {
  std::span<const char> left = stream.frame.bytes();
  for (const std::size_t size : stream.frame.datagram_sizes()) {
    if (datagrams-- == 0) return;
    note_sent(link_.traffic, stream.target.at, left.first(size));
    left = left.subspan(size);
  }
}

std::optional<std::int64_t> Streams::wait() const {
  if (streams_.empty()) return std::nullopt;
  const auto next = std::ranges::min_element(streams_, {}, [](const auto& s) { return s->due; });
  return std::max<std::int64_t>(0, (*next)->due - clock_.steady());
}

}  // namespace limber
