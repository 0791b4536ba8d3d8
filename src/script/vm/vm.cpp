// The Lua state: creation, prelude, calls, garbage collection.
#include "script/vm/vm.h"

#include <algorithm>

#include <fmt/format.h>
#include <lua.hpp>

#include "base/check.h"
#include "base/log/log.h"
#include "base/memory/archive.h"
#include "base/text.h"
#include "script/api/script_context.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/scene/scene.h"
#include "script/vm/text_check.h"
#include "sim/behavior/behavior_list.h"
#include "sim/visuals/visuals.h"

namespace limber::script {

namespace {

constexpr std::size_t kMaxArguments = 4000;  // max. arguments of a message for a handler; Lua's stack is limited

void push(lua_State* L, std::string_view text) { lua_pushlstring(L, text.data(), text.size()); }

// function, arguments … -> true if the guarded call succeeded
template <Guard::Kind kind>
int guarded(lua_State* L) {
  Guard& guard = *static_cast<Guard*>(lua_touserdata(L, lua_upvalueindex(1)));
  lua_pushboolean(L, guard.call(lua_gettop(L) - 1, 0, kind) ? 1 : 0);
  return 1;
}

// feeds a text to the compiler in blocks, so that it can be stopped between them
struct TextReader {
  Guard& guard;
  const char* text;
  std::size_t left;
  static const char* next(lua_State*, void* self, std::size_t* size) {
    constexpr std::size_t kBlockSize = 256;
    auto& reader = *static_cast<TextReader*>(self);
    if (reader.guard.stop_requested()) reader.left = 0;
    *size = std::min(kBlockSize, reader.left);
    const char* const block = reader.text;
    reader.text += *size;
    reader.left -= *size;
    return block;
  }
};

void* heap_block(void* heap, void* block, std::size_t before, std::size_t after) {
  return static_cast<Arena*>(heap)->resize(block, before, after);
}

// with the libraries, since opening the jit library turns the compiler on
lua_State* open_state(Arena& heap) {
  lua_State* const L = heap.exists() ? lua_newstate(heap_block, &heap) : luaL_newstate();
  luaL_openlibs(L);
  return L;
}

// text, name, environment -> function, or nil and an error message; never loads bytecode
int load_text(lua_State* L) {
  std::size_t size = 0;
  const char* const text = lua_tolstring(L, 1, &size);
  if (const std::optional<TextFault> fault = text_fault({text, size})) {
    lua_pushnil(L);
    lua_pushfstring(L, "%s:%d: %s", lua_tostring(L, 2) + 1, fault->line, fault->message.c_str());
    return 2;
  }
  TextReader reader{*static_cast<Guard*>(lua_touserdata(L, lua_upvalueindex(1))), text, size};
  if (lua_loadx(L, &TextReader::next, &reader, lua_tostring(L, 2), "t") != 0) {
    lua_pushnil(L);
    lua_insert(L, -2);
    return 2;
  }
  lua_pushvalue(L, 3);
  lua_setfenv(L, -2);
  return 1;
}

}  // namespace

void Vm::Closer::operator()(lua_State* state) const { lua_close(state); }

Vm::Vm(ScriptContext& context, VmMode wanted)
    : state_(open_state(heap_)), guard_(state_.get(), context, context.options.limits) {
  context.guard = &guard_;
  load_prelude(context);
  store_exports();
  context.behaviors->attach(*this);
  if (wanted == VmMode::compiled) enable_jit();
  collector_.emplace(state_.get(), guard_.memory());
}

Vm::~Vm() = default;

void Vm::load_prelude(ScriptContext& context) {
  lua_State* const L = state_.get();
  lua_newtable(L);  // the table P shared by the prelude's files
  push(L, limber_cdef());
  lua_setfield(L, -2, "cdef");
  lua_pushlightuserdata(L, const_cast<LimberApi*>(&limber_api()));
  lua_setfield(L, -2, "api");
  lua_pushlightuserdata(L, &context);
  lua_setfield(L, -2, "context");
  const auto set_id_fields = [&](const std::string& name, NodeId id) {
    lua_pushnumber(L, id.slot);
    lua_setfield(L, -2, (name + "_slot").c_str());
    lua_pushnumber(L, id.generation);
    lua_setfield(L, -2, (name + "_generation").c_str());
  };
  const sim::Visuals& visuals = context.world->visuals();
  set_id_fields("world", context.world->id());
  set_id_fields("visuals", visuals.id());
  set_id_fields("camera", visuals.camera().id());
  set_id_fields("look", visuals.appearance().id());
  set_id_fields("clock", context.world->behaviors().clock().id());
  const auto guard_function = [&](const char* name, lua_CFunction function) {
    lua_pushlightuserdata(L, &guard_);
    lua_pushcclosure(L, function, 1);
    lua_setfield(L, -2, name);
  };
  guard_function("guarded", guarded<Guard::Kind::call>);
  guard_function("guarded_run", guarded<Guard::Kind::run>);
  guard_function("load", load_text);
  for (const PreludeChunk& chunk : compiled_prelude()) {
    int fault = luaL_loadbuffer(L, chunk.bytecode.data(), chunk.bytecode.size(), chunk.name.c_str());
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

void Vm::store_exports() {
  lua_State* const L = state_.get();
  lua_getfield(L, -1, "exports");
  const auto reference = [L](const char* name) {
    lua_getfield(L, -1, name);
    return luaL_ref(L, LUA_REGISTRYINDEX);
  };
  if (lua_istable(L, -1)) {
    run_ = reference("run");
    start_ = reference("start");
    tick_ = reference("tick");
    message_ = reference("message");
    names_ = reference("names");
    Guard::Functions functions;
    functions.handler = reference("handler");
    functions.stopped_fault = reference("stopped_fault");
    functions.failed = reference("failed");
    guard_.set_functions(functions);
    lua_pushvalue(L, -1);
    exports_ = luaL_ref(L, LUA_REGISTRYINDEX);
    warm_ = reference("warm");
    behaviors_.store_exports();
  }
  lua_settop(L, 0);
}

// compiles the most frequently used prelude functions before scripts call them
bool Vm::enable_jit() {
  if (!guard_.enable_jit()) return false;
  lua_rawgeti(state_.get(), LUA_REGISTRYINDEX, warm_);
  call(0, 0);
  return true;
}

Result<void> Vm::run(std::string_view text, std::string_view name, std::string_view added, ScriptPlace& fault) {
  lua_State* const L = state_.get();
  collector_->begin_run();
  lua_rawgeti(L, LUA_REGISTRYINDEX, run_);
  push(L, text);
  push(L, name);
  push(L, added);
  const bool called = call(3, 1);
  const bool success = called && lua_toboolean(L, -1) != 0;
  lua_settop(L, 0);
  collector_->end_run();
  if (success) return {};
  if (!called) return Error{fmt::format("{}: the scene could not be run", name)};
  guard_.attribute_to_file(name);
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

void Vm::compute_results() {
  collector_->begin_calls();
  push_export("results");
  call(0, 0);
}

bool Vm::handle_message(const Message& message, const CommandOrigin& origin) {
  lua_State* const L = state_.get();
  if (message.args.size() > kMaxArguments || lua_checkstack(L, static_cast<int>(message.args.size()) + 8) == 0) {
    log_warning("{}: {} arguments are more than a script's handler can receive ({})", printable(message.address),
                message.args.size(), kMaxArguments);
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
  const bool handled = call(static_cast<int>(message.args.size()) + 2, 1) && lua_toboolean(L, -1) != 0;
  lua_settop(L, 0);
  return handled;
}

Evaluation Vm::query(const char* function, std::string_view text) {
  using Kind = Evaluation::Kind;
  constexpr std::pair<std::string_view, Kind> kKinds[] = {
      {"value", Kind::value}, {"error", Kind::error}, {"incomplete", Kind::incomplete}, {"names", Kind::names}};
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, exports_);
  lua_getfield(L, -1, function);
  push(L, text);
  Evaluation result;
  if (call(1, 3)) {
    for (const auto& [word, kind] : kKinds) {
      if (text_at(L, -3) == word) result.kind = kind;
    }
    result.text = shortened(text_at(L, -2), kMaxEvaluatedBytes);
    result.word = static_cast<std::size_t>(lua_tonumber(L, -1));
  } else {
    result = {Kind::error, "internal error of the console; see the log"};
  }
  lua_settop(L, 0);
  return result;
}

std::string Vm::names() {
  lua_State* const L = state_.get();
  lua_rawgeti(L, LUA_REGISTRYINDEX, names_);
  std::string names = call(0, 1) ? std::string(text_at(L, -1)) : std::string();
  lua_settop(L, 0);
  return names;
}

void Vm::copy_heap(PageStore& pages, const PageStore::PageList* previous, PageStore::PageList& out) {
  luaJIT_setmode(state_.get(), 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_FLUSH);
  heap_.capture(pages, previous, out);
}

void Vm::restore_heap(const PageStore& pages, const PageStore::PageList& image) {
  luaJIT_setmode(state_.get(), 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_FLUSH);
  heap_.restore(pages, image);
}

void Vm::serialize_counts(Archive& archive) {
  guard_.serialize(archive);
  collector_->serialize(archive);
}

void Vm::collect_garbage() {
  if (guard_.consume_memory_stop()) collector_->collect_all();
  collector_->after_tick();
}

}  // namespace limber::script
