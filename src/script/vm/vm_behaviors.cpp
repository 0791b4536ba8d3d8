// Calls into behaviors of behaviors_lua/.
#include <lua.hpp>

#include "script/vm/vm.h"

namespace limber {

namespace {

std::string string_at(lua_State* L, int index) {
  std::size_t length = 0;
  const char* const text = lua_tolstring(L, index, &length);
  return text == nullptr ? std::string() : std::string(text, length);
}

}  // namespace

// pushes an instance's function and its self; false if it has no such function
bool Vm::push_behavior(int functions, std::int32_t number) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, functions);
  lua_rawgeti(L, LUA_REGISTRYINDEX, behavior_self_);
  lua_rawgeti(L, -2, number);
  lua_rawgeti(L, -2, number);
  if (!lua_isnil(L, -2)) return true;
  lua_settop(L, 0);
  return false;
}

// guarded call of the function pushed by push_behavior, with further arguments
BehaviorFault Vm::guarded_behavior(int arguments, int results) {
  collector_->begin_calls();
  if (guard_.call(arguments, results)) return {};
  lua_settop(state_.get(), 0);
  const ScriptFault& fault = guard_.fault();
  return {fault.text, fault.file, fault.line};
}

std::int32_t Vm::make_behavior(std::int32_t file, NodeId id) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, make_behavior_);
  lua_pushnumber(L, file);
  lua_pushnumber(L, id.slot);
  lua_pushnumber(L, id.generation);
  const std::int32_t number = call(3, 1) ? static_cast<std::int32_t>(lua_tointeger(L, -1)) : 0;
  lua_settop(L, 0);
  return number;
}

BehaviorFault Vm::start_behavior(std::int32_t number) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, clear_behavior_lists_);
  lua_pushnumber(L, number);
  call(1, 0);
  if (!push_behavior(behavior_start_, number)) return {};
  BehaviorFault fault = guarded_behavior(1, 0);
  lua_settop(L, 0);
  return fault;
}

BehaviorFault Vm::step_behavior(std::int32_t number, double dt) {
  lua_State* const L = state_.get();
  push_behavior(behavior_step_, number);
  lua_pushnumber(L, dt);
  BehaviorFault fault = guarded_behavior(2, 0);
  lua_settop(L, 0);
  return fault;
}

BehaviorFault Vm::step_behaviors(double dt, const std::int32_t& stepping) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, step_behaviors_);
  lua_pushnumber(L, dt);
  BehaviorFault fault = guarded_behavior(1, 0);
  // the instance was stopped in its last instruction
  if (!fault.text.empty() && fault.line == 0 && push_behavior(behavior_step_, stepping)) {
    lua_settop(L, -2);
    guard_.attribute_to_function();
    fault = {guard_.fault().text, guard_.fault().file, guard_.fault().line};
  }
  lua_settop(L, 0);
  return fault;
}

BehaviorFault Vm::restore_behavior(std::int32_t number, std::string_view state, bool migrate) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, restore_behavior_);
  lua_pushnumber(L, number);
  lua_pushlstring(L, state.data(), state.size());
  if (!call(2, 1) || !migrate || !push_behavior(behavior_migrate_, number)) {
    lua_settop(L, 0);
    return {};
  }
  lua_pushvalue(L, 1);  // the previous state
  if (BehaviorFault fault = guarded_behavior(2, 1); !fault.text.empty()) return fault;
  lua_rawgeti(L, LUA_REGISTRYINDEX, accept_migrated_state_);
  lua_pushnumber(L, number);
  lua_pushvalue(L, -3);
  BehaviorFault fault;
  if (call(2, 3) && !lua_isnil(L, -3)) {
    fault = {string_at(L, -3), string_at(L, -2), static_cast<int>(lua_tointeger(L, -1))};
  }
  lua_settop(L, 0);
  return fault;
}

Result<std::string> Vm::behavior_state(std::int32_t number) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, behavior_state_);
  lua_pushnumber(L, number);
  if (!call(1, 2)) return Error{"its state could not be read"};
  Result<std::string> state = string_at(L, -2);
  if (lua_isnil(L, -2)) state = Error{string_at(L, -1)};
  lua_settop(L, 0);
  return state;
}

void Vm::drop_behavior(std::int32_t number) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, drop_behavior_);
  lua_pushnumber(L, number);
  call(1, 0);
}

}  // namespace limber
