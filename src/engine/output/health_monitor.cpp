// HealthMonitor: the sources of the items of Health.
#include "engine/output/health_monitor.h"
#include "sim/behavior/behavior_list.h"

namespace limber::engine {

void HealthMonitor::update(bool not_owned) {
  constexpr std::uint64_t kReadInterval = 16;  // passes between two reads of counters that take longer
  EngineLink& link = show_.link;
  Health& health = link.health;
  Counters& counters = link.counters;
  const Session& session = *show_.session;
  const std::size_t handlers = session.scene == nullptr ? 0 : session.scene->disabled_handlers();
  counters.disabled.store(handlers, std::memory_order_relaxed);
  health.set(HealthItem::handlers, handlers);
  health.set(HealthItem::dropped, counters.dropped.load(std::memory_order_relaxed));
  health.set(HealthItem::dropped_kernel, counters.dropped_kernel.load(std::memory_order_relaxed));
  health.set(HealthItem::discarded, counters.discarded.load(std::memory_order_relaxed));
  health.set(HealthItem::unheard, counters.unheard.load(std::memory_order_relaxed));
  health.set(HealthItem::unanswered, link.output_queue.dropped() + link.query_output_queue.dropped());
  health.set(HealthItem::output, lost_output_lines() - lines_lost_before_);
  health.set(HealthItem::files, failed_writes() - writes_failed_before_);
  health.set(HealthItem::not_owned, not_owned ? 1 : 0);
  health.set(HealthItem::late, show_.pacer.stalls());
  health.add(HealthItem::stopped, show_.call_log.stopped().size());
  // a new session or a rewind may have a smaller number
  const std::uint64_t events = session.world.stability().events();
  if (events > health_events_) health.add(HealthItem::bodies, events - health_events_);
  health_events_ = events;
  if (passes_++ % kReadInterval != 0) return;
  health.set(HealthItem::behaviors, session.world.behaviors().suspended_count());
  health.set(HealthItem::log, log_suppressed() - log_suppressed_before_);
}

}  // namespace limber::engine
