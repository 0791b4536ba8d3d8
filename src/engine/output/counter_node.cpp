// The readouts of /osc.
#include "engine/output/counter_node.h"

#include <atomic>
#include <string>
#include <utility>

namespace limber::engine {

namespace {

using namespace properties;

Property counter(std::string name, std::string doc) {
  return transient(readout(integer(std::move(name), 0, 0, kUnbounded, std::move(doc))));
}

}  // namespace

const PropertyTable& CounterNode::table() {
  static const PropertyTable table(
      "osc", "/osc", "",
      {
          counter("received", "Complete messages received."),
          counter("malformed", "Datagrams that are not valid OSC."),
          counter("denied", "Datagrams from senders that --osc-allow does not list."),
          counter("unknown", "Messages with an unknown address."),
          counter("refused", "Messages rejected because of their arguments or names."),
          counter("clamped", "Messages with values that were clamped to their range."),
          counter("dropped", "Messages dropped because more arrived than a tick can handle."),
          counter("dropped_kernel", "Datagrams dropped by the kernel because its buffer was full."),
          counter("sent", "Datagrams sent."),
          counter("unsent", "Datagrams that could not be sent or delivered."),
          counter("discarded",
                  "Requests (play, step, ...) discarded because of a later panic, pause or end of a take."),
          counter("unheard", "Messages that osc:on handlers missed because their time budget was exceeded."),
          counter("disabled", "Handlers (osc:on) that failed and are disabled until the scene is saved."),
          text_from<&CounterNode::read_targets>(
              text("targets", "Targets of OSC output, one per line: host and port, then the settings in parentheses.")),
      });
  return table;
}

CounterNode::CounterNode(Store& store, const Counters& counters, const OscStatus& status)
    : store_(store), counters_(counters), status_(status), id_(store.add(table(), store.root(), "osc", this)) {}

std::string_view CounterNode::read_targets() const {
  const std::uint64_t version = status_.version();
  if (version != version_) targets_ = status_.targets();
  version_ = version;
  return targets_;
}

void CounterNode::publish() {
  // in the order of the properties
  const Counters& counters = counters_;
  const std::atomic<std::uint64_t>* const all[] = {
      &counters.received,  &counters.malformed, &counters.denied,         &counters.unknown, &counters.refused,
      &counters.clamped,   &counters.dropped,   &counters.dropped_kernel, &counters.sent,    &counters.unsent,
      &counters.discarded, &counters.unheard,   &counters.disabled};
  double* out = store_.transient_block(id_);
  for (const auto* count : all) *out++ = static_cast<double>(count->load(std::memory_order_relaxed));
}

}  // namespace limber::engine
