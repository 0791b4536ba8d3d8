// Engine: output: answers, events, health, and the messages and prints of scripts.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/log/output.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

void Engine::send_error(std::string_view address, const CommandOrigin& origin, std::string_view error) {
  push_out({Outgoing::Destination::error, origin, error_message(address, error)});
}

void Engine::report_clamped(const Message& message, const Property& property) {
  if (std::find(reported_clamped_.begin(), reported_clamped_.end(), &property) != reported_clamped_.end()) return;
  reported_clamped_.push_back(&property);
  log_warning("{}: value clamped to {} (reported once for {})", printable(message.address), range_text(property),
              property.name);
}

// Reports each text once, because a slider on a preset would fill the log.
void Engine::report_warning(const std::string& text) {
  constexpr std::size_t kMaxTexts = 64;
  if (std::find(reported_warnings_.begin(), reported_warnings_.end(), text) != reported_warnings_.end()) return;
  if (reported_warnings_.size() >= kMaxTexts) reported_warnings_.erase(reported_warnings_.begin());
  reported_warnings_.push_back(text);
  log_warning("{} (reported once)", text);
}

void Engine::send_contacts() {
  const Store& store = session_->store;
  for (const ContactEvent& contact : session_->world.contacts()) {
    if (!store.alive(contact.part) || !store.alive(contact.other)) continue;
    const auto* part = static_cast<const Part*>(store.object(contact.part));
    const auto* other = static_cast<const Part*>(store.object(contact.other));
    push_out({Outgoing::Destination::event,
              {},
              {"/physics/contact",
               {Arg::of(part->body().name()), Arg::of(part->name()), Arg::of(other->body().name()),
                Arg::of(other->name()), Arg::of(contact.impulse), Arg::of(contact.position.x),
                Arg::of(contact.position.y), Arg::of(contact.position.z)}}});
  }
}

void Engine::push_out(Outgoing out) {
  const bool answer =
      out.destination == Outgoing::Destination::sender || out.destination == Outgoing::Destination::error;
  if (resimulating_ || (answer && suppress_answers_)) return;
  link_.push_out(std::move(out));
}

void Engine::send_transport() {
  was_paused_ = session_->transport.paused();
  push_out({Outgoing::Destination::event,
            {},
            {"/transport/state",
             {Arg::of(was_paused_), Arg::of(static_cast<double>(session_->world.tick())),
              Arg::of(session_->world.time()), Arg::of(clock_.speed_reached())}}});
}

// Copies the counters of other modules into Health, once a pass.
void Engine::update_health() {
  constexpr std::uint64_t kReadInterval = 16;  // passes between two reads of counters that take longer
  Health& health = link_.health;
  Counters& counters = link_.counters;
  const std::size_t handlers = session_->scene == nullptr ? 0 : session_->scene->disabled_handlers();
  counters.disabled.store(handlers, std::memory_order_relaxed);
  health.set(HealthItem::handlers, handlers);
  health.set(HealthItem::dropped, counters.dropped.load(std::memory_order_relaxed));
  health.set(HealthItem::dropped_kernel, counters.dropped_kernel.load(std::memory_order_relaxed));
  health.set(HealthItem::discarded, counters.discarded.load(std::memory_order_relaxed));
  health.set(HealthItem::unheard, counters.unheard.load(std::memory_order_relaxed));
  health.set(HealthItem::unanswered, link_.output_queue.dropped() + link_.query_output_queue.dropped());
  health.set(HealthItem::output, lost_output_lines() - lines_lost_before_);
  health.set(HealthItem::files, failed_writes() - writes_failed_before_);
  health.set(HealthItem::not_owned, recovery_ != nullptr && !recovery_->owned() ? 1 : 0);
  health.set(HealthItem::late, clock_.stalls());
  health.add(HealthItem::stopped, call_log_.stopped().size());
  // a new session or a rewind may have a smaller number
  const std::uint64_t events = session_->world.health_events();
  if (events > health_events_) health.add(HealthItem::bodies, events - health_events_);
  health_events_ = events;
  if (passes_++ % kReadInterval != 0) return;
  health.set(HealthItem::behaviors, session_->world.behaviors().suspended_count());
  health.set(HealthItem::log, log_suppressed() - log_suppressed_before_);
}

void Engine::send(Message message) { push_out({Outgoing::Destination::targets, {}, std::move(message)}); }
void Engine::reply(const CommandOrigin& to, Message message) {
  push_out({Outgoing::Destination::sender, to, std::move(message)});
}
void Engine::send_direct(const CommandOrigin& to, Message message) {
  push_out({Outgoing::Destination::direct, to, std::move(message)});
}

void Engine::configure_osc(const OscConfig& config) {
  if (resimulating_) return;
  const std::shared_ptr<OscConfig> published = link_.osc_config.acquire_buffer();
  *published = config;
  link_.osc_config.publish(published);
  link_.wake_network();
}

void Engine::print(std::string_view text) {
  if (resimulating_) return;
  log_print(text, options_.print ? OutputTo::out : OutputTo::error);
}

void Engine::script_error(std::string_view file, int line, std::string_view text) {
  if (resimulating_) return;
  if (text.empty()) {
    push_out({Outgoing::Destination::event, {}, {"/script/ok", {Arg::of(file)}}});
    log_info("{}{}", file, kResolvedSuffix);
    return;
  }
  faults_++;
  reloader_.note_error(file);
  log_line(LogLevel::error, text, fmt::format("{}:{}", file, line));
  push_out({Outgoing::Destination::event,
            {},
            {"/script/error",
             {Arg::of(file), Arg::of(static_cast<double>(line)), Arg::of(shortened(text, kMaxErrorText))}}});
}

}  // namespace limber
