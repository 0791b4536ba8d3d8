// Each pass reads one snapshot, so that all targets that are due get the same tick.
#include "net/osc/streams.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/log/log.h"
#include "base/system/net/udp_socket.h"
#include "base/text.h"
#include "net/osc/sender.h"

namespace limber::osc {

namespace {

std::int64_t period_of(const StreamTarget& config) {
  return static_cast<std::int64_t>(1e9 / std::clamp(config.rate, 0.1, 1000.0));
}

bool wants_streams(const StreamTarget& config) { return config.pos || config.rot || config.relrot || config.relpos; }

bool wants_frames(const StreamTarget& config) { return wants_streams(config) || !config.messages.empty(); }

}  // namespace

Streams::Streams(engine::EngineLink& link, const engine::TransientOffsets& offsets, const NetClock& clock,
                 SendGate may_serve)
    : link_(link), offsets_(offsets), clock_(clock), may_serve_(std::move(may_serve)) {}

void Streams::set_targets(const std::vector<ResolvedTarget>& targets) {
  std::vector<std::unique_ptr<Stream>> streams;
  for (const ResolvedTarget& target : targets) {
    if (!wants_frames(target.config)) continue;
    const auto old = std::ranges::find_if(streams_, [&](const auto& s) { return s && s->target == target; });
    streams.push_back(old != streams_.end() ? std::move(*old)
                                            : std::make_unique<Stream>(target, offsets_, clock_.steady()));
  }
  streams_ = std::move(streams);
}

void Streams::send_due(system::UdpSender& sender) {
  const std::int64_t now = clock_.steady();
  std::shared_ptr<const engine::Snapshot> snapshot;
  const std::size_t begin = first_;
  std::size_t served = 0;  // bytes to subscribers
  for (std::size_t i = 0; i < streams_.size(); i++) {
    Stream& stream = *streams_[(begin + i) % streams_.size()];
    if (stream.next_due > now || (stream.target.subscribed && served >= kSliceBytes)) continue;
    const std::int64_t period = period_of(stream.target.config);
    stream.next_due += ((now - stream.next_due) / period + 1) * period;
    if (!snapshot) snapshot = link_.snapshots.read();
    if (!snapshot) continue;
    if (!stream.target.config.messages.empty()) send_templates(sender, stream);
    if (!wants_streams(stream.target.config)) continue;
    const std::size_t bytes = send_frame(sender, stream, *snapshot);
    if (!stream.target.subscribed) continue;
    served += bytes;
    if (served >= kSliceBytes) first_ = (begin + i + 1) % streams_.size();
  }
}

// Returns the number of bytes of the frame, 0 if it was skipped.
std::size_t Streams::send_frame(system::UdpSender& sender, Stream& stream, const engine::Snapshot& snapshot) {
  stream.frame.lay_out(snapshot.body_list, stream.target.config);
  if (!stream.frame.too_large().empty() && stream.reported_too_large != snapshot.body_list) {
    stream.reported_too_large = snapshot.body_list;
    log_warning("OSC out: body '{}' has too many joints for one message and is not streamed",
                printable(stream.frame.too_large().front()));
  }
  const std::size_t bytes = stream.frame.bytes().size();
  if (stream.target.subscribed && !may_serve_(stream.target.endpoint, bytes, stream.frame.datagram_sizes().size()))
    return 0;
  stream.frame.fill(snapshot);
  send(sender, stream, stream.frame);
  return bytes;
}

// The values are those of the newest value snapshot; the next one is requested now. The first frame waits for one.
void Streams::send_templates(system::UdpSender& sender, Stream& stream) {
  const std::shared_ptr<const engine::ValueSnapshot> values = link_.value_snapshots.read();
  (void)link_.request_value_snapshot();
  if (values == nullptr) return;
  stream.templates.lay_out(values->tree, stream.target.config);
  if (stream.reported != stream.templates.problems()) {
    stream.reported = stream.templates.problems();
    for (const std::string& problem : stream.reported)
      log_warning("OSC out {}: {}", endpoint_text(stream.target.endpoint), problem);
  }
  stream.templates.fill(*values);
  send(sender, stream, stream.templates);
}

template <class Frame>
void Streams::send(system::UdpSender& sender, Stream& stream, const Frame& frame) {
  const std::span<const std::uint32_t> sizes = frame.datagram_sizes();
  const Endpoint& to = stream.target.endpoint;
  const system::BatchResult result = tcp_ != nullptr && tcp_->is_connected(to)
                                         ? send_by_tcp(to, frame.bytes(), sizes)
                                         : sender.send(to, frame.bytes(), sizes, stream.segmentation);
  link_.counters.sent.fetch_add(result.sent, std::memory_order_relaxed);
  if (link_.message_log.enabled()) log_frame(stream, frame.bytes(), sizes, result.sent);
  if (result.error == 0) return;
  link_.counters.unsent.fetch_add(sizes.size() - result.sent, std::memory_order_relaxed);
  if (const auto more = lost_log_.admit(clock_.steady())) {
    log_warning("OSC out {}: {} of {} datagrams of a frame not sent: {}. Stream fewer bodies or at a lower rate{}",
                endpoint_text(stream.target.endpoint), sizes.size() - result.sent, sizes.size(),
                std::generic_category().message(result.error), *more);
  }
}

system::BatchResult Streams::send_by_tcp(const Endpoint& to, std::span<const char> bytes,
                                         std::span<const std::uint32_t> sizes) {
  system::BatchResult result;
  for (const std::uint32_t size : sizes) {
    result.error = tcp_->send(to, bytes.first(size));
    if (result.error != 0) break;
    result.sent++;
    bytes = bytes.subspan(size);
  }
  return result;
}

void Streams::log_frame(const Stream& stream, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                        std::size_t datagrams) {
  for (const std::size_t size : sizes) {
    if (datagrams-- == 0) return;
    log_sent(link_.message_log, stream.target.endpoint, bytes.first(size));
    bytes = bytes.subspan(size);
  }
}

std::optional<std::int64_t> Streams::timeout() const {
  if (streams_.empty()) return std::nullopt;
  const auto next = std::ranges::min_element(streams_, {}, [](const auto& s) { return s->next_due; });
  return std::max<std::int64_t>(0, (*next)->next_due - clock_.steady());
}

}  // namespace limber::osc
