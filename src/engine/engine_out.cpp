// Engine: what goes out: answers, events, what scripts send and print.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/output.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

void Engine::refuse(std::string_view address, const Origin& origin, std::string_view error) {
  push_out({Outgoing::To::error, origin, error_message(address, error)});
}

void Engine::say_clamped(const Message& message, const Row& row) {
  if (std::find(said_clamped_.begin(), said_clamped_.end(), &row) != said_clamped_.end()) return;
  said_clamped_.push_back(&row);
  log_warning("{}: a value outside {} was brought into this range (said once for {})", printable(message.address),
              range_text(row), row.name);
}

// a slider on a preset would fill the log
void Engine::say_left_out(const std::string& text) {
  constexpr std::size_t kLately = 64;
  if (std::find(said_left_out_.begin(), said_left_out_.end(), text) != said_left_out_.end()) return;
  if (said_left_out_.size() >= kLately) said_left_out_.erase(said_left_out_.begin());
  said_left_out_.push_back(text);
  log_warning("{} (said once)", text);
}

void Engine::send_contacts() {
  const Store& store = stage_->store;
  for (const ContactEvent& contact : stage_->world.contacts()) {
    if (!store.alive(contact.part) || !store.alive(contact.other)) continue;
    const auto* part = static_cast<const Part*>(store.thing(contact.part));
    const auto* other = static_cast<const Part*>(store.thing(contact.other));
    push_out({Outgoing::To::event,
              {},
              {"/physics/contact",
               {Arg::of(part->body().name()), Arg::of(part->name()), Arg::of(other->body().name()),
                Arg::of(other->name()), Arg::of(contact.impulse), Arg::of(contact.position.x),
                Arg::of(contact.position.y), Arg::of(contact.position.z)}}});
  }
}

void Engine::push_out(Outgoing out) {
  const bool answer = out.to == Outgoing::To::sender || out.to == Outgoing::To::error;
  if (again_ || (answer && answers_taken_)) return;
  link_.push_out(std::move(out));
}

void Engine::send_transport() {
  was_paused_ = stage_->transport.paused();
  push_out({Outgoing::To::event,
            {},
            {"/transport/state",
             {Arg::of(was_paused_), Arg::of(static_cast<double>(stage_->world.tick())), Arg::of(stage_->world.time()),
              Arg::of(clock_.speed_reached())}}});
}

// what others count, read once a pass
void Engine::tell_health() {
  constexpr std::uint64_t kLookEvery = 16;  // passes between two looks at what takes longer
  Health& health = link_.health;
  Counters& counters = link_.counters;
  const std::size_t handlers = stage_->scene == nullptr ? 0 : stage_->scene->disabled_handlers();
  counters.disabled.store(handlers, std::memory_order_relaxed);
  health.set(HealthItem::handlers, handlers);
  health.set(HealthItem::dropped, counters.dropped.load(std::memory_order_relaxed));
  health.set(HealthItem::dropped_kernel, counters.dropped_kernel.load(std::memory_order_relaxed));
  health.set(HealthItem::discarded, counters.discarded.load(std::memory_order_relaxed));
  health.set(HealthItem::unheard, counters.unheard.load(std::memory_order_relaxed));
  health.set(HealthItem::unanswered, link_.outbox.dropped() + link_.query_outbox.dropped());
  health.set(HealthItem::output, lost_output_lines() - lines_lost_before_);
  health.set(HealthItem::files, failed_writes() - writes_failed_before_);
  health.set(HealthItem::not_owned, recovery_ != nullptr && !recovery_->owned() ? 1 : 0);
  health.set(HealthItem::late, clock_.let_go());
  health.add(HealthItem::stopped, calls_.stopped().size());
  // another stage and a rewind begin with other numbers
  const std::uint64_t events = stage_->world.health_events();
  if (events > health_events_) health.add(HealthItem::bodies, events - health_events_);
  health_events_ = events;
  if (passes_++ % kLookEvery != 0) return;
  health.set(HealthItem::behaviors, stage_->world.behaviors().suspended());
  health.set(HealthItem::log, log_left_out() - left_out_before_);
}

void Engine::send(Message message) { push_out({Outgoing::To::targets, {}, std::move(message)}); }
void Engine::reply(const Origin& to, Message message) { push_out({Outgoing::To::sender, to, std::move(message)}); }
void Engine::send_direct(const Origin& to, Message message) {
  push_out({Outgoing::To::direct, to, std::move(message)});
}

void Engine::plan_osc(const OscPlan& plan) {
  if (again_) return;
  const std::shared_ptr<OscPlan> planned = link_.osc_plan.spare();
  *planned = plan;
  link_.osc_plan.publish(planned);
  link_.wake_network();
}

void Engine::print(std::string_view text) {
  if (again_) return;
  log_print(text, options_.print ? OutputTo::out : OutputTo::error);
}

void Engine::script_error(std::string_view file, int line, std::string_view text) {
  if (again_) return;
  if (text.empty()) {
    push_out({Outgoing::To::event, {}, {"/script/ok", {Arg::of(file)}}});
    log_info("{}{}", file, kMended);
    return;
  }
  faults_++;
  reload_.faulty(file);
  log_line(LogLevel::error, text, fmt::format("{}:{}", file, line));
  push_out({Outgoing::To::event,
            {},
            {"/script/error",
             {Arg::of(file), Arg::of(static_cast<double>(line)), Arg::of(shortened(text, kMostFaultText))}}});
}

}  // namespace limber
