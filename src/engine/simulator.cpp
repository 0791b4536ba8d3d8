// Simulator: the phases of a pass after its messages.
#include "engine/simulator.h"

#include <utility>

#include <fmt/format.h>

#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::engine {

void Simulator::simulate(bool running, InputSource& input, PhaseTimes& times) {
  Session& session = *show_.session;
  system::Stopwatch watch;
  panic_.end_if_requested();
  if (running) show_.presets.advance(session.world);
  if (running && !session.world.panic().on()) show_.cues.advance();
  call_handlers(input);
  if (running && session.scene != nullptr && !session.world.panic().on()) session.scene->tick(session.world.timestep());
  execute_preset_requests();
  panic_.begin_if_requested();
  show_.undo_stack.end(session.store);
  show_.output().flush_changes(session.store);
  times.scripts = watch.lap();
  if (!running) return session.world.flush();
  session.dispatcher.apply_mouse_springs();
  const sim::TickTimes physics = session.world.step();
  times.behaviors = physics.behaviors;
  times.callbacks = physics.flush;
  times.physics = physics.physics;
  times.readouts = physics.readouts;
  send_contacts();
}

void Simulator::call_handlers(InputSource& input) {
  EditScope edit_scope = show_.edit_scope();
  input.begin_handlers();
  std::uint64_t called = 0;
  while (!show_.handler_queue.empty() && input.may_call_handler(called)) {
    edit_scope.begin(show_.handler_queue.front().origin);
    call_handler();
    called++;
  }
  input.end_handlers(called);
}

void Simulator::call_handler() {
  const HandlerQueue::Entry entry = show_.handler_queue.pop();
  script::Scene* const scene = show_.session->scene.get();
  const bool handled = scene != nullptr && scene->handle_message(entry.message, entry.origin);
  if (!handled && entry.unknown) show_.output().report_unknown(entry.message, entry.origin, entry.error);
}

// Executes the preset commands of scripts, in order.
void Simulator::execute_preset_requests() {
  if (show_.preset_requests.empty()) return;
  EditScope edit_scope = show_.edit_scope();
  edit_scope.begin({CommandSource::script});
  for (std::size_t i = 0; i < show_.preset_requests.size(); i++) {
    const Message& request = show_.preset_requests[i];
    const Outcome outcome = show_.session->dispatcher.execute(request);
    if (outcome.kind == Outcome::Kind::rejected)
      show_.output().report_fault(fmt::format("{} of a script: {}", request.address, outcome.error));
    if (!outcome.warning.empty()) show_.output().warn_once(outcome.warning);
  }
  show_.preset_requests.clear();
}

void Simulator::send_contacts() {
  const Store& store = show_.session->store;
  for (const sim::ContactEvent& contact : show_.session->world.sensing().contacts().events()) {
    if (!store.alive(contact.part) || !store.alive(contact.other)) continue;
    const auto* part = static_cast<const sim::Part*>(store.object(contact.part));
    const auto* other = static_cast<const sim::Part*>(store.object(contact.other));
    show_.output().push({Outgoing::Destination::event,
                         {},
                         {"/physics/contact",
                          {Arg::of(part->body().name()), Arg::of(part->name()), Arg::of(other->body().name()),
                           Arg::of(other->name()), Arg::of(contact.impulse), Arg::of(contact.position.x),
                           Arg::of(contact.position.y), Arg::of(contact.position.z)}}});
  }
  send_contact_points();
}

void Simulator::send_contact_points() {
  const Store& store = show_.session->store;
  const sim::ContactPoints& points = show_.session->world.sensing().contacts().points();
  for (const sim::PartContact& contact : points.streamed()) {
    const sim::ContactPoint& point = points.list()[contact.point];
    const bool is_a = point.a == contact.part;
    const NodeId other_id = is_a ? point.b : point.a;
    if (!store.alive(contact.part) || !store.alive(other_id)) continue;
    const auto* part = static_cast<const sim::Part*>(store.object(contact.part));
    const auto* other = static_cast<const sim::Part*>(store.object(other_id));
    const Vec3 normal = is_a ? point.normal : -point.normal;
    Message message{"/physics/contact/point",
                    {Arg::of(part->body().name()), Arg::of(part->name()), Arg::of(other->body().name()),
                     Arg::of(other->name()), Arg::of(point.impulse / points.seconds())}};
    for (const Vec3& v : {point.position, normal}) {
      for (int i = 0; i < 3; i++) message.args.push_back(Arg::of(v[i]));
    }
    show_.output().push({Outgoing::Destination::event, {}, std::move(message)});
  }
}

}  // namespace limber::engine
