// Calls into behaviors of behaviors_lua/.
#include "script/vm/behavior_calls.h"

#include <lua.hpp>

#include "script/vm/vm.h"

namespace limber::script {

namespace {

std::string string_at(lua_State* L, int index) {
  std::size_t length = 0;
  const char* const text = lua_tolstring(L, index, &length);
  return text == nullptr ? std::string() : std::string(text, length);
}

}  // namespace

void BehaviorCalls::store_exports() {
  lua_State* const L = vm_.state();
  const auto reference = [L](const char* name) {
    lua_getfield(L, -1, name);
    return luaL_ref(L, LUA_REGISTRYINDEX);
  };
  make_ = reference("make_behavior");
  clear_lists_ = reference("clear_behavior_lists");
  restore_ = reference("restore_behavior");
  accept_migrated_state_ = reference("accept_migrated_state");
  step_all_ = reference("step_behaviors");
  state_ = reference("behavior_state");
  drop_ = reference("drop_behavior");
  self_of_ = reference("behavior_self");
  start_of_ = reference("behavior_start");
  step_of_ = reference("behavior_step");
  migrate_of_ = reference("behavior_migrate");
}

// pushes an instance's function and its self; false if it has no such function
bool BehaviorCalls::push(int functions, std::int32_t number) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, functions);
  lua_rawgeti(L, LUA_REGISTRYINDEX, self_of_);
  lua_rawgeti(L, -2, number);
  lua_rawgeti(L, -2, number);
  if (!lua_isnil(L, -2)) return true;
  lua_settop(L, 0);
  return false;
}

// guarded call of the function pushed by push(), with further arguments
sim::BehaviorFault BehaviorCalls::guarded_call(int arguments, int results) {
  vm_.collector().begin_calls();
  if (vm_.guard().call(arguments, results)) return {};
  lua_settop(vm_.state(), 0);
  const ScriptFault& fault = vm_.guard().fault();
  return {fault.text, fault.file, fault.line};
}

std::int32_t BehaviorCalls::make(std::int32_t file, NodeId id) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, make_);
  lua_pushnumber(L, file);
  lua_pushnumber(L, id.slot);
  lua_pushnumber(L, id.generation);
  const std::int32_t number = call_export(L, 3, 1) ? static_cast<std::int32_t>(lua_tointeger(L, -1)) : 0;
  lua_settop(L, 0);
  return number;
}

sim::BehaviorFault BehaviorCalls::start(std::int32_t number) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, clear_lists_);
  lua_pushnumber(L, number);
  call_export(L, 1, 0);
  if (!push(start_of_, number)) return {};
  sim::BehaviorFault fault = guarded_call(1, 0);
  lua_settop(L, 0);
  return fault;
}

sim::BehaviorFault BehaviorCalls::step(std::int32_t number, double dt) {
  lua_State* const L = vm_.state();
  push(step_of_, number);
  lua_pushnumber(L, dt);
  sim::BehaviorFault fault = guarded_call(2, 0);
  lua_settop(L, 0);
  return fault;
}

sim::BehaviorFault BehaviorCalls::step_all(double dt, const std::int32_t& stepping) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, step_all_);
  lua_pushnumber(L, dt);
  sim::BehaviorFault fault = guarded_call(1, 0);
  // the instance was stopped in its last instruction
  if (!fault.text.empty() && fault.line == 0 && push(step_of_, stepping)) {
    lua_settop(L, -2);
    vm_.guard().attribute_to_function();
    fault = {vm_.guard().fault().text, vm_.guard().fault().file, vm_.guard().fault().line};
  }
  lua_settop(L, 0);
  return fault;
}

sim::BehaviorFault BehaviorCalls::restore(std::int32_t number, std::string_view state, bool migrate) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, restore_);
  lua_pushnumber(L, number);
  lua_pushlstring(L, state.data(), state.size());
  if (!call_export(L, 2, 1) || !migrate || !push(migrate_of_, number)) {
    lua_settop(L, 0);
    return {};
  }
  lua_pushvalue(L, 1);  // the previous state
  if (sim::BehaviorFault fault = guarded_call(2, 1); !fault.text.empty()) return fault;
  lua_rawgeti(L, LUA_REGISTRYINDEX, accept_migrated_state_);
  lua_pushnumber(L, number);
  lua_pushvalue(L, -3);
  sim::BehaviorFault fault;
  if (call_export(L, 2, 3) && !lua_isnil(L, -3)) {
    fault = {string_at(L, -3), string_at(L, -2), static_cast<int>(lua_tointeger(L, -1))};
  }
  lua_settop(L, 0);
  return fault;
}

Result<std::string> BehaviorCalls::state(std::int32_t number) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, state_);
  lua_pushnumber(L, number);
  if (!call_export(L, 1, 2)) return Error{"its state could not be read"};
  Result<std::string> state = string_at(L, -2);
  if (lua_isnil(L, -2)) state = Error{string_at(L, -1)};
  lua_settop(L, 0);
  return state;
}

void BehaviorCalls::drop(std::int32_t number) {
  lua_State* const L = vm_.state();
  lua_rawgeti(L, LUA_REGISTRYINDEX, drop_);
  lua_pushnumber(L, number);
  call_export(L, 1, 0);
}

}  // namespace limber::script
