// The Lua state: opened, filled with the prelude, called, collected.
#include "script/vm.h"

#include <chrono>

#include <fmt/format.h>
#include <lua.hpp>

#include "base/check.h"
#include "base/log.h"
#include "script/behavior_scripts.h"
#include "script/context.h"
#include "script/prelude.h"

namespace limber {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kSlice = std::chrono::microseconds(100);
constexpr double kGrowthFactor = 1.5;  // a cycle begins when the heap has grown by half and 512 kB
constexpr double kGrowth = 512;

void push(lua_State* L, std::string_view text) { lua_pushlstring(L, text.data(), text.size()); }

std::string_view text_at(lua_State* L, int index) {
  std::size_t length = 0;
  const char* text = lua_tolstring(L, index, &length);
  return text == nullptr ? std::string_view("an error without text") : std::string_view(text, length);
}

double kilobytes(lua_State* L) {
  return lua_gc(L, LUA_GCCOUNT, 0) + static_cast<double>(lua_gc(L, LUA_GCCOUNTB, 0)) / 1024;
}

std::string sender_text(const Origin& origin) {
  if (origin.ip != 0) {
    return fmt::format("{}.{}.{}.{}:{}", origin.ip >> 24 & 255u, origin.ip >> 16 & 255u, origin.ip >> 8 & 255u,
                       origin.ip & 255u, origin.port);
  }
  constexpr std::string_view kHands[] = {"osc", "command_line", "console", "panel", "script"};
  return std::string(kHands[static_cast<std::size_t>(origin.hand)]);
}

}  // namespace

void Vm::Close::operator()(lua_State* state) const { lua_close(state); }

Vm::Vm(ScriptContext& context) : state_(luaL_newstate()) {
  lua_State* const L = state_.get();
  luaL_openlibs(L);
  load_prelude(context);
  keep_entries();
  context.behaviors->open(*this);
  lua_gc(L, LUA_GCCOLLECT, 0);
  used_after_cycle_ = kilobytes(L);
  lua_gc(L, LUA_GCSTOP, 0);
}

Vm::~Vm() = default;

void Vm::load_prelude(ScriptContext& context) {
  lua_State* const L = state_.get();
  lua_newtable(L);  // what the files share: their P
  push(L, limber_cdef());
  lua_setfield(L, -2, "cdef");
  lua_pushlightuserdata(L, const_cast<LimberApi*>(&limber_api()));
  lua_setfield(L, -2, "api");
  lua_pushlightuserdata(L, &context);
  lua_setfield(L, -2, "context");
  const NodeId world = context.world.id();
  lua_pushnumber(L, world.slot);
  lua_setfield(L, -2, "world_slot");
  lua_pushnumber(L, world.generation);
  lua_setfield(L, -2, "world_generation");
  for (const PreludeFile& file : prelude_files()) {
    const std::string name = fmt::format("=limber {}", file.name);
    int fault = luaL_loadbuffer(L, file.text.data(), file.text.size(), name.c_str());
    if (fault == 0) {
      lua_pushvalue(L, -2);
      fault = lua_pcall(L, 1, 0, 0);
    }
    const bool prelude_runs = fault == 0;
    if (prelude_runs) continue;
    log_error("script: {}", text_at(L, -1));
    LIMBER_CHECK(prelude_runs);
    lua_pop(L, 1);
  }
}

void Vm::keep_entries() {
  lua_State* const L = state_.get();
  lua_getfield(L, -1, "entry");
  const auto keep = [L](const char* name) {
    lua_getfield(L, -1, name);
    return luaL_ref(L, LUA_REGISTRYINDEX);
  };
  if (lua_istable(L, -1)) {
    run_ = keep("run");
    start_ = keep("start");
    tick_ = keep("tick");
    message_ = keep("message");
    names_ = keep("names");
    handler_ = keep("handler");
    make_behavior_ = keep("make_behavior");
    renew_behavior_ = keep("renew_behavior");
    restore_behavior_ = keep("restore_behavior");
    behavior_state_ = keep("behavior_state");
    drop_behavior_ = keep("drop_behavior");
    behavior_self_ = keep("behavior_self");
    behavior_start_ = keep("behavior_start");
    behavior_step_ = keep("behavior_step");
    behavior_migrate_ = keep("behavior_migrate");
  }
  lua_settop(L, 0);
}

// an entry catches what scripts throw; what still comes out is a fault of the prelude
bool Vm::call(int arguments, int results) {
  lua_State* const L = state_.get();
  const bool entry_caught_all = lua_pcall(L, arguments, results, 0) == 0;
  if (entry_caught_all) return true;
  log_error("script: {}", text_at(L, -1));
  LIMBER_CHECK(entry_caught_all);
  lua_settop(L, 0);
  return false;
}

Result<void> Vm::run(std::string_view text, std::string_view name) {
  lua_State* const L = state_.get();
  lua_gc(L, LUA_GCRESTART, 0);
  lua_rawgeti(L, LUA_REGISTRYINDEX, run_);
  push(L, text);
  push(L, name);
  Result<void> result;
  if (!call(2, 1)) {
    result = Error{fmt::format("{}: the scene could not be run", name)};
  } else if (!lua_isnil(L, -1)) {
    result = Error{std::string(text_at(L, -1))};
  }
  lua_settop(L, 0);
  lua_gc(L, LUA_GCSTOP, 0);
  return result;
}

void Vm::start() {
  lua_rawgeti(state_.get(), LUA_REGISTRYINDEX, start_);
  call(0, 0);
}

void Vm::tick(double dt) {
  lua_rawgeti(state_.get(), LUA_REGISTRYINDEX, tick_);
  lua_pushnumber(state_.get(), dt);
  call(1, 0);
}

bool Vm::message(const Message& message, const Origin& origin) {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, message_);
  push(L, message.address);
  push(L, sender_text(origin));
  luaL_checkstack(L, static_cast<int>(message.args.size()) + 8, "too many arguments");
  for (const Arg& arg : message.args) {
    switch (arg.kind) {
      case Arg::Kind::number:
        lua_pushnumber(L, arg.number);
        break;
      case Arg::Kind::boolean:
        lua_pushboolean(L, arg.number != 0);
        break;
      case Arg::Kind::text:
        push(L, arg.text);
        break;
      case Arg::Kind::nil:
        lua_pushnil(L);
        break;
    }
  }
  const bool heard = call(static_cast<int>(message.args.size()) + 2, 1) && lua_toboolean(L, -1) != 0;
  lua_settop(L, 0);
  return heard;
}

std::string Vm::names() {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, names_);
  std::string names = call(0, 1) ? std::string(text_at(L, -1)) : std::string();
  lua_settop(L, 0);
  return names;
}

void Vm::collect_garbage() {
  lua_State* const L = state_.get();
  const double used = kilobytes(L);
  const double limit = used_after_cycle_ * kGrowthFactor + kGrowth;
  if (!collecting_ && used < limit) return;
  collecting_ = true;
  // a script that makes more than a slice can collect gets longer ones
  const Clock::time_point end = Clock::now() + (used > 2 * limit ? 10 * kSlice : kSlice);
  do {
    if (lua_gc(L, LUA_GCSTEP, 1) != 0) {
      collecting_ = false;
      used_after_cycle_ = kilobytes(L);
      break;
    }
  } while (Clock::now() < end);
  lua_gc(L, LUA_GCSTOP, 0);  // a step starts the collector again
}

}  // namespace limber
