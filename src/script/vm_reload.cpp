// Vm: a run beside the show, from its start to the moment when it becomes the show; and an earlier one, whose timers go
// on when another has taken its place.
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

std::string Vm::text_of(const char* entry) {
  lua_State* const L = state_.get();
  std::string text;
  push_entry(entry);
  if (call(0, 1)) {
    std::size_t length = 0;
    const char* const bytes = lua_tolstring(L, -1, &length);
    if (bytes != nullptr) text.assign(bytes, length);
  }
  lua_settop(L, 0);
  return text;
}

std::uint64_t Vm::count_of(const char* entry) {
  push_entry(entry);
  const std::uint64_t count = call(0, 1) ? static_cast<std::uint64_t>(lua_tonumber(state_.get(), -1)) : 0;
  lua_settop(state_.get(), 0);
  return count;
}

std::string Vm::state_text() { return text_of("state"); }

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

Vm::CallbackTimers Vm::callback_timers() {
  lua_State* const L = state_.get();
  CallbackTimers all;
  push_entry("callback_timers");
  if (call(0, 2)) {
    all.timers = static_cast<std::uint64_t>(lua_tonumber(L, -2));
    all.repeating = static_cast<std::uint64_t>(lua_tonumber(L, -1));
  }
  lua_settop(L, 0);
  return all;
}

std::uint64_t Vm::become_earlier() { return count_of("become_earlier"); }

std::string Vm::afters_text() { return text_of("afters"); }

void Vm::take_afters(std::string_view afters) {
  push_entry("take_afters");
  lua_pushlstring(state_.get(), afters.data(), afters.size());
  call(1, 0);
}

void Vm::call_with(const char* entry, double number) {
  push_entry(entry);
  lua_pushnumber(state_.get(), number);
  call(1, 0);
}

void Vm::number_run(std::uint64_t number) { call_with("number_run", static_cast<double>(number)); }

void Vm::cancel_timer(std::int32_t number) { call_with("cancel_timer", number); }

void Vm::gather_handles() {
  push_entry("gather");
  call(0, 0);
}

void Vm::handles_moved() {
  push_entry("things_moved");
  call(0, 0);
}

bool Vm::timers_due() {
  push_entry("timers_due");
  const bool due = call(0, 1) && lua_toboolean(state_.get(), -1) != 0;
  lua_settop(state_.get(), 0);
  return due;
}

std::uint64_t Vm::run_timers() {
  collector_->begin_calls();
  return count_of("run_timers");
}

void Vm::change_state(std::string_view before, std::string_view after) {
  push_entry("change_state");
  lua_pushlstring(state_.get(), before.data(), before.size());
  lua_pushlstring(state_.get(), after.data(), after.size());
  call(2, 0);
}

}  // namespace limber
