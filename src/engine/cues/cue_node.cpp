// The properties and actions of /cue.
#include "engine/cues/cue_node.h"

namespace limber::engine {

const PropertyTable& CueNode::table() {
  using namespace properties;
  static const PropertyTable table(
      "cue", "/cue", "",
      {
          text_from<&CueNode::read_names>(text("names", "Names of the cues, one per line, in order.")),
          text_from<&CueNode::read_fields>(
              text("fields",
                   "The cues, one per line, with tabs between name, preset, time, easing, at, when, follow and note.")),
          text_from<&CueNode::read_name>(text("name", "Name of the cue that has run last; empty: none.")),
          transient(readout(integer("current", 0, 0, static_cast<double>(kMaxCues),
                                    "Number of the cue that has run last, from 1; 0: none."))),
          transient(readout(number("follow", "s", 0, 0, kUnbounded,
                                   "Simulated time until the next cue starts by itself; 0: it waits for go."))),
          transient(readout(integer("waiting", 0, 0, static_cast<double>(kMaxCues),
                                    "Number of the cue that waits for its beat or bar; 0: none. Starting it again "
                                    "runs it at once."))),
          transient(readout(boolean("paused", false, "True if the time until the next cue is paused."))),
          invokes<&CueNode::act_go>(action("go", 0, 0, "Starts the next cue.")),
          invokes<&CueNode::act_back>(action("back", 0, 0, "Starts the cue before the last one again.")),
          invokes<&CueNode::act_pause>(
              action("pause", 0, 1,
                     "Pauses (1) or resumes (0) the time until the next cue starts by itself; without a value: the "
                     "other one. go resumes it, too.")),
          invokes<&CueNode::act_jump>(action("jump", 1, 1, "Starts a cue by number (or name).")),
      });
  return table;
}

CueNode::CueNode(sim::World& world, const CuePlayer& cues)
    : world_(world), cues_(cues), id_(world.store().add(table(), world.store().root(), "cue", this)) {}

void CueNode::publish() {
  static const Property& first = table().at("current");
  const CueState& state = cues_.state();
  double* const out = world_.store().mutable_values(id_, first);  // the readouts are contiguous
  out[0] = state.number;
  out[1] = state.ticks ? *state.ticks * world_.timestep() : 0;
  out[2] = state.waiting;
  out[3] = state.paused ? 1 : 0;
}

Result<void> CueNode::act_go(std::span<const double>) {
  request_ = CueRequest{CueRequest::Kind::go};
  return {};
}

Result<void> CueNode::act_back(std::span<const double>) {
  request_ = CueRequest{CueRequest::Kind::back};
  return {};
}

Result<void> CueNode::act_pause(std::span<const double> args) {
  request_ = CueRequest{CueRequest::Kind::pause, args.empty() ? Arg{} : Arg::of(args[0])};
  return {};
}

Result<void> CueNode::act_jump(std::span<const double> args) {
  request_ = CueRequest{CueRequest::Kind::jump, Arg::of(args[0])};
  return {};
}

}  // namespace limber::engine
