// SavedStates: a checkpoint, and the conditions under which it can be restored.
#include "engine/saved_states.h"

#include <utility>

namespace limber::engine {

SavedState SavedStates::save(const SavedState* previous) {
  Session& session = *show_.session;
  const bool shares = previous != nullptr && previous->history_clears == show_.history.clears() &&
                      previous->structure_version == session.store.structure_version();
  return {store_.capture(session, shares ? previous->checkpoint.get() : nullptr), session.store.structure_version(),
          show_.history.clears()};
}

Result<void> SavedStates::restore(const SavedState& state) {
  Session& session = *show_.session;
  if (state.history_clears != show_.history.clears())
    return Error{"the scene has run again since this state was saved; save a new one after a reset"};
  if (state.structure_version != session.store.structure_version())
    return Error{"the scene has added or removed objects since this state was saved; save a new one"};
  PresetList list = show_.presets.list();
  store_.restore(session, *state.checkpoint);
  show_.presets.set_list(std::move(list));
  show_.preset_requests.clear();
  session.dispatcher.begin_pass();
  return {};
}

}  // namespace limber::engine
