// The Lua state: opened, filled with the prelude, called, collected.
#include "script/vm.h"

#include <algorithm>

#include <fmt/format.h>
#include <lua.hpp>

#include "base/check.h"
#include "base/key_bytes.h"
#include "base/log.h"
#include "base/text.h"
#include "script/behavior_scripts.h"
#include "script/context.h"
#include "script/prelude.h"
#include "script/scene.h"
#include "script/text_check.h"

namespace limber {

namespace {

constexpr std::size_t kMostArguments = 4000;  // of a message that a handler hears; Lua's stack has an end

void push(lua_State* L, std::string_view text) { lua_pushlstring(L, text.data(), text.size()); }

std::string_view text_at(lua_State* L, int index) {
  std::size_t length = 0;
  const char* text = lua_tolstring(L, index, &length);
  return text == nullptr ? std::string_view("an error without text") : std::string_view(text, length);
}

// function, arguments … -> whether the guarded call ended well
template <Guard::Kind kind>
int guarded(lua_State* L) {
  Guard& guard = *static_cast<Guard*>(lua_touserdata(L, lua_upvalueindex(1)));
  lua_pushboolean(L, guard.call(lua_gettop(L) - 1, 0, kind) ? 1 : 0);
  return 1;
}

// a text in pieces, between which the compiler can be stopped
struct Pieces {
  Guard& guard;
  const char* text;
  std::size_t left;
  static const char* next(lua_State*, void* self, std::size_t* size) {
    constexpr std::size_t kPiece = 256;
    auto& pieces = *static_cast<Pieces*>(self);
    if (pieces.guard.stop_asked()) pieces.left = 0;
    *size = std::min(kPiece, pieces.left);
    const char* const piece = pieces.text;
    pieces.text += *size;
    pieces.left -= *size;
    return piece;
  }
};

void* heap_block(void* heap, void* block, std::size_t before, std::size_t after) {
  return static_cast<Arena*>(heap)->resize(block, before, after);
}

// with the libraries: opening that of the compiler switches it on
lua_State* open_state(Arena& heap) {
  lua_State* const L = heap.exists() ? lua_newstate(heap_block, &heap) : luaL_newstate();
  luaL_openlibs(L);
  return L;
}

// text, name, environment -> function, or nil and what is wrong; never bytecode
int load_text(lua_State* L) {
  std::size_t size = 0;
  const char* const text = lua_tolstring(L, 1, &size);
  if (const std::optional<TextFault> fault = text_fault({text, size})) {
    lua_pushnil(L);
    lua_pushfstring(L, "%s:%d: %s", lua_tostring(L, 2) + 1, fault->line, fault->what.c_str());
    return 2;
  }
  Pieces pieces{*static_cast<Guard*>(lua_touserdata(L, lua_upvalueindex(1))), text, size};
  if (lua_loadx(L, &Pieces::next, &pieces, lua_tostring(L, 2), "t") != 0) {
    lua_pushnil(L);
    lua_insert(L, -2);
    return 2;
  }
  lua_pushvalue(L, 3);
  lua_setfenv(L, -2);
  return 1;
}

}  // namespace

void Vm::Close::operator()(lua_State* state) const { lua_close(state); }

Vm::Vm(ScriptContext& context, VmMode wanted)
    : state_(open_state(heap_)), guard_(state_.get(), context, context.options.limits) {
  context.guard = &guard_;
  load_prelude(context);
  keep_entries();
  context.behaviors->open(*this);
  if (wanted == VmMode::live) arm();
  collector_.emplace(state_.get(), guard_.memory());
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
  const auto only = [&](const std::string& name, NodeId id) {
    lua_pushnumber(L, id.slot);
    lua_setfield(L, -2, (name + "_slot").c_str());
    lua_pushnumber(L, id.generation);
    lua_setfield(L, -2, (name + "_generation").c_str());
  };
  const Visuals& visuals = context.world->visuals();
  only("world", context.world->id());
  only("visuals", visuals.id());
  only("camera", visuals.camera().id());
  only("look", visuals.look().id());
  const auto guard_function = [&](const char* name, lua_CFunction function) {
    lua_pushlightuserdata(L, &guard_);
    lua_pushcclosure(L, function, 1);
    lua_setfield(L, -2, name);
  };
  guard_function("guarded", guarded<Guard::Kind::call>);
  guard_function("guarded_run", guarded<Guard::Kind::run>);
  guard_function("load", load_text);
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
    const int handler = keep("handler");
    const int stopped_fault = keep("stopped_fault");
    guard_.use(handler, stopped_fault, keep("failed"));
    lua_pushvalue(L, -1);
    entries_ = luaL_ref(L, LUA_REGISTRYINDEX);
    warm_ = keep("warm");
    make_behavior_ = keep("make_behavior");
    renew_behavior_ = keep("renew_behavior");
    restore_behavior_ = keep("restore_behavior");
    migrated_behavior_ = keep("migrated_behavior");
    step_behaviors_ = keep("step_behaviors");
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

// LuaJIT works at what scripts will call most before they do
bool Vm::arm() {
  if (!guard_.arm()) return false;
  lua_rawgeti(state_.get(), LUA_REGISTRYINDEX, warm_);
  call(0, 0);
  return true;
}

Result<void> Vm::run(std::string_view text, std::string_view name, ScriptPlace& fault) {
  lua_State* const L = state_.get();
  collector_->begin_run();
  lua_rawgeti(L, LUA_REGISTRYINDEX, run_);
  push(L, text);
  push(L, name);
  const bool called = call(2, 1);
  const bool good = called && lua_toboolean(L, -1) != 0;
  lua_settop(L, 0);
  collector_->end_run();
  if (good) return {};
  if (!called) return Error{fmt::format("{}: the scene could not be run", name)};
  fault = {guard_.fault().file, guard_.fault().line};
  return Error{guard_.fault().text};
}

void Vm::start() {
  collector_->begin_calls();
  lua_rawgeti(state_.get(), LUA_REGISTRYINDEX, start_);
  call(0, 0);
}

void Vm::tick(double dt) {
  collector_->begin_calls();
  lua_rawgeti(state_.get(), LUA_REGISTRYINDEX, tick_);
  lua_pushnumber(state_.get(), dt);
  call(1, 0);
}

bool Vm::message(const Message& message, const Origin& origin) {
  lua_State* const L = state_.get();
  if (message.args.size() > kMostArguments || lua_checkstack(L, static_cast<int>(message.args.size()) + 8) == 0) {
    log_warning("{}: {} arguments are more than a script's handler takes ({})", printable(message.address),
                message.args.size(), kMostArguments);
    return false;
  }
  lua_rawgeti(L, LUA_REGISTRYINDEX, message_);
  push(L, message.address);
  push(L, sender_text(origin));
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
  collector_->begin_calls();
  const bool heard = call(static_cast<int>(message.args.size()) + 2, 1) && lua_toboolean(L, -1) != 0;
  lua_settop(L, 0);
  return heard;
}

Evaluation Vm::ask(const char* entry, std::string_view text) {
  using Kind = Evaluation::Kind;
  constexpr std::pair<std::string_view, Kind> kKinds[] = {
      {"value", Kind::value}, {"error", Kind::error}, {"incomplete", Kind::incomplete}, {"names", Kind::names}};
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, entries_);
  lua_getfield(L, -1, entry);
  push(L, text);
  Evaluation said;
  if (call(1, 3)) {
    for (const auto& [word, kind] : kKinds) {
      if (text_at(L, -3) == word) said.kind = kind;
    }
    said.text = shortened(text_at(L, -2), kMostEvaluated);
    said.word = static_cast<std::size_t>(lua_tonumber(L, -1));
  } else {
    said = {Kind::error, "the console has a fault, the log tells which"};
  }
  lua_settop(L, 0);
  return said;
}

std::string Vm::names() {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, names_);
  std::string names = call(0, 1) ? std::string(text_at(L, -1)) : std::string();
  lua_settop(L, 0);
  return names;
}

void Vm::copy_heap(PageStore& pages, const PageStore::Image* before, PageStore::Image& out) {
  luaJIT_setmode(state_.get(), 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_FLUSH);
  heap_.copy(pages, before, out);
}

void Vm::bring_back_heap(const PageStore& pages, const PageStore::Image& image) {
  luaJIT_setmode(state_.get(), 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_FLUSH);
  heap_.bring_back(pages, image);
}

void Vm::pass_counts(KeyBytes& key) {
  guard_.pass_memory(key);
  collector_->pass_memory(key);
}

void Vm::collect_garbage() {
  if (guard_.take_memory_stop()) collector_->collect_all();
  collector_->after_tick();
}

}  // namespace limber
