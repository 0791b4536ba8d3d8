// Vm: detached runs and going live; earlier runs, which keep their timers after they were replaced.
#include <lua.hpp>

#include "script/vm/vm.h"

namespace limber::script {

// pushes a prelude function by name; functions that are called once per reload have no registry reference
void Vm::push_export(const char* name) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, exports_);
  lua_getfield(L, -1, name);
  lua_remove(L, -2);
}

std::string Vm::text_from(const char* name) {
  lua_State* const L = state_.get();
  std::string text;
  push_export(name);
  if (call(0, 1)) {
    std::size_t length = 0;
    const char* const bytes = lua_tolstring(L, -1, &length);
    if (bytes != nullptr) text.assign(bytes, length);
  }
  lua_settop(L, 0);
  return text;
}

std::uint64_t Vm::count_from(const char* name) {
  push_export(name);
  const std::uint64_t count = call(0, 1) ? static_cast<std::uint64_t>(lua_tonumber(state_.get(), -1)) : 0;
  lua_settop(state_.get(), 0);
  return count;
}

std::string Vm::state_text() { return text_from("state"); }

void Vm::begin_detached(std::string_view state) {
  lua_State* const L = state_.get();
  push_export("set_initial_state");
  lua_pushlstring(L, state.data(), state.size());
  call(1, 0);
}

void Vm::prepare() {
  push_export("prepare");
  call(0, 0);
}

void Vm::adopt_state(std::string_view state) {
  push_export("adopt_state");
  lua_pushlstring(state_.get(), state.data(), state.size());
  call(1, 0);
}

void Vm::become_live(std::optional<double> timers_at) {
  lua_State* const L = state_.get();
  push_export("become_live");
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
  push_export("callback_timers");
  if (call(0, 2)) {
    all.timers = static_cast<std::uint64_t>(lua_tonumber(L, -2));
    all.repeating = static_cast<std::uint64_t>(lua_tonumber(L, -1));
  }
  lua_settop(L, 0);
  return all;
}

std::uint64_t Vm::retire() { return count_from("retire"); }

std::string Vm::delayed_timers_text() { return text_from("delayed_timers"); }

void Vm::adopt_delayed_timers(std::string_view timers) {
  push_export("adopt_delayed_timers");
  lua_pushlstring(state_.get(), timers.data(), timers.size());
  call(1, 0);
}

void Vm::call_with(const char* name, double number) {
  push_export(name);
  lua_pushnumber(state_.get(), number);
  call(1, 0);
}

void Vm::set_run_number(std::uint64_t number) { call_with("set_run_number", static_cast<double>(number)); }

void Vm::cancel_timer(std::int32_t number) { call_with("cancel_timer", number); }

void Vm::gather_handles() {
  push_export("gather_handles");
  call(0, 0);
}

void Vm::handles_moved() {
  push_export("handles_moved");
  call(0, 0);
}

bool Vm::timers_due() {
  push_export("timers_due");
  const bool due = call(0, 1) && lua_toboolean(state_.get(), -1) != 0;
  lua_settop(state_.get(), 0);
  return due;
}

std::uint64_t Vm::run_timers() {
  collector_->begin_calls();
  return count_from("run_timers");
}

void Vm::apply_state_changes(std::string_view before, std::string_view after) {
  push_export("change_state");
  lua_pushlstring(state_.get(), before.data(), before.size());
  lua_pushlstring(state_.get(), after.data(), after.size());
  call(2, 0);
}

}  // namespace limber::script
