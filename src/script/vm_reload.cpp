// Vm: a run beside the show, from its start to the moment when it becomes the show.
#include <lua.hpp>

#include "script/vm.h"

namespace limber {

// a function of the prelude by its name: what is called once a reload has no place of its own
void Vm::push_entry(const char* name) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, entries_);
  lua_getfield(L, -1, name);
  lua_remove(L, -2);
}

std::string Vm::state_text() {
  lua_State* const L = state_.get();
  std::string text;
  push_entry("state");
  if (call(0, 1)) {
    std::size_t length = 0;
    const char* const bytes = lua_tolstring(L, -1, &length);
    if (bytes != nullptr) text.assign(bytes, length);
  }
  lua_settop(L, 0);
  return text;
}

void Vm::begin_beside(std::string_view state) {
  lua_State* const L = state_.get();
  push_entry("give_state");
  lua_pushlstring(L, state.data(), state.size());
  call(1, 0);
}

void Vm::prepare() {
  push_entry("prepare");
  call(0, 0);
}

void Vm::take_state(std::string_view state) {
  push_entry("take_state");
  lua_pushlstring(state_.get(), state.data(), state.size());
  call(1, 0);
}

void Vm::become_live(std::optional<double> timers_at) {
  lua_State* const L = state_.get();
  push_entry("become_live");
  if (timers_at) {
    lua_pushnumber(L, *timers_at);
  } else {
    lua_pushnil(L);
  }
  call(1, 0);
}

}  // namespace limber
