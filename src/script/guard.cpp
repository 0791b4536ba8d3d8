// Guarded calls. How compiled loops are stopped: LuaJIT as Debian builds it does not look at hooks there, but its
// profiler, once started in the mode 'l', puts a look at one flag into each of them. Raising that flag makes compiled
// code leave to the interpreter, and a hook that counts to one raises the error there, again and again, until the call
// has ended.
#include "script/guard.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <lua.hpp>

#include "base/check.h"
#include "base/key_bytes.h"
#include "base/system/signals.h"
#include "script/call_ledger.h"
#include "script/context.h"

namespace limber {

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
// calls must be noticed this soon after they begin, as a part of their budget; at most every 4 ms
std::int64_t poll_of(const ScriptLimits& limits) {
  return std::clamp(static_cast<std::int64_t>(limits.call_ms * kMillisecond / 10), std::int64_t{200'000},
                    4 * kMillisecond);
}

thread_local Guard* running_here = nullptr;

// the profiler is one for the whole process: who has it is live
std::atomic<Guard*> live_guard{nullptr};
void (*leave_compiled_code)(int) = nullptr;  // the profiler's signal handler: raises the flag

void no_profile(void*, lua_State*, int, int) {}

int raise(lua_State* state) { return lua_error(state); }

// LuaJIT 2.1.0-beta3 on arm64 (Debian 12) compiles a multiplication and an addition to one fused instruction, which
// rounds differently than its interpreter, so scripts are only interpreted there.
bool compiles_like_interpreter() {
#if defined(__aarch64__)
  return std::string_view(LUAJIT_VERSION) != "LuaJIT 2.1.0-beta3";
#else
  return true;
#endif
}

// `rounds` of a loop, calls of a function, and exits of compiled code
void compile_after(lua_State* L, int rounds) {
  lua_getfield(L, LUA_REGISTRYINDEX, "_LOADED");
  lua_getfield(L, -1, "jit.opt");
  lua_getfield(L, -1, "start");
  lua_pushfstring(L, "hotloop=%d", rounds);
  lua_pushfstring(L, "hotexit=%d", rounds);
  lua_call(L, 2, 0);
  lua_pop(L, 2);
}

}  // namespace

Guard::Guard(lua_State* state, ScriptContext& context, const ScriptLimits& limits)
    : state_(state),
      context_(context),
      limits_(limits),
      memory_(
          limits.memory, [](void* guard) { static_cast<Guard*>(guard)->stop(Reason::memory); }, this),
      watchdog_(Watchdog::instance()) {
  memory_.attach(state_);
  watch_.owner = this;
  watch_.stop = [](Watch& watch) { static_cast<Guard*>(watch.owner)->stop(Reason::time); };
  watchdog_->add(watch_, poll_of(limits));
  luaJIT_setmode(state_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
}

Guard::~Guard() {
  watchdog_->remove(watch_);
  disarm();
  memory_.detach(state_);
}

void Guard::limit(const ScriptLimits& limits) {
  limits_ = limits;
  memory_.limit(limits.memory);
  watchdog_->remove(watch_);
  watchdog_->add(watch_, poll_of(limits));
}

void Guard::use(int handler, int stopped_fault, int failed) {
  lua_pushlightuserdata(state_, this);
  lua_rawgeti(state_, LUA_REGISTRYINDEX, handler);
  lua_pushcclosure(state_, &Guard::on_error, 2);
  handler_ = luaL_ref(state_, LUA_REGISTRYINDEX);
  stopped_fault_ = stopped_fault;
  failed_ = failed;
}

bool Guard::arm() {
  if (live_) return true;
  Guard* nobody = nullptr;
  if (!live_guard.compare_exchange_strong(nobody, this)) return false;
  luaJIT_profile_start(state_, "li1000000000", no_profile, nullptr);
  // only its handler is wanted, not its clock
  leave_compiled_code = system::take_profile_handler();
  if (limits_.compiled && compiles_like_interpreter()) {
    luaJIT_setmode(state_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_ON);
    if (limits_.hot_loop > 0) compile_after(state_, limits_.hot_loop);
  }
  live_ = true;
  return true;
}

void Guard::disarm() {
  if (!live_) return;
  live_ = false;
  luaJIT_profile_stop(state_);
  luaJIT_setmode(state_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
  live_guard = nullptr;
}

bool Guard::call(int arguments, int results, Kind kind) {
  const bool outermost = !running_;
  LIMBER_CHECK(outermost);
  lua_State* const L = state_;
  if (!outermost) {
    lua_settop(L, lua_gettop(L) - arguments - 1);
    fault_ = {"", 0, "a guarded call inside another", false};
    return false;
  }
  if (kind == Kind::call && context_.calls != nullptr && context_.calls->forbids_next()) return skip_call(arguments);
  // the function once more, for faults that come without a place, and the message handler
  const int function = lua_gettop(L) - arguments;
  lua_pushvalue(L, function);
  lua_insert(L, function);
  lua_rawgeti(L, LUA_REGISTRYINDEX, handler_);
  lua_insert(L, function + 1);
  begin(kind);
  const int status = lua_pcall(L, arguments, results, function + 1);
  end();
  const bool good = status == 0 && !fired_;
  if (good) {
    lua_remove(L, function + 1);
    lua_remove(L, function);
  } else {
    take_fault(status, function);
    lua_settop(L, function - 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, failed_);
    lua_pcall(L, 0, 0, 0);
    lua_settop(L, function - 1);
    if (fault_.stopped && kind == Kind::call && context_.calls != nullptr)
      context_.calls->note_stop(fault_.file, fault_.line, fault_.text);
  }
  if (kind == Kind::call) context_.end_call(good);
  return good;
}

// a call that was stopped when the take was recorded: it fails as it did then
bool Guard::skip_call(int arguments) {
  context_.begin_call();
  const StoppedCall& stop = context_.calls->skip();
  fault_ = {stop.file, stop.line, stop.text, true};
  lua_settop(state_, lua_gettop(state_) - arguments - 1);
  lua_rawgeti(state_, LUA_REGISTRYINDEX, failed_);
  lua_pcall(state_, 0, 0, 0);
  context_.end_call(false);
  return false;
}

void Guard::begin(Kind kind) {
  kind_ = kind;
  running_ = true;
  fired_ = false;
  overflowed_ = false;
  hooked_ = false;
  reason_ = Reason::none;
  if (kind == Kind::call) {
    if (context_.calls != nullptr) context_.calls->count();
    context_.begin_call();
  }
  memory_.begin_call(again_);
  running_here = this;
  const double budget = again_ ? limits_.again_ms : kind == Kind::call ? limits_.call_ms : limits_.run_ms;
  watch_.begin(static_cast<std::int64_t>(budget * kMillisecond));
}

void Guard::pass_memory(KeyBytes& key) {
  memory_.pass(key);
  key.pass(memory_stop_);
}

bool Guard::next_call(bool& changed) {
  if (context_.calls != nullptr && context_.calls->forbids_next()) return false;
  // from here on nobody stops the call before: what has asked until now is seen
  watch_.next();
  if (reason_ != Reason::none || (memory_.used() > memory_.cap() / 2 && !again_)) return false;
  if (context_.calls != nullptr) context_.calls->count();
  if (context_.next_call()) changed = true;
  memory_.begin_call(again_);
  return true;
}

void Guard::blame_function() {
  if (fault_.line == 0) place_at_function(lua_gettop(state_));
}

void Guard::end() {
  watch_.end();
  memory_.end_call();
  running_here = nullptr;
  running_ = false;
  if (!hooked_) return;
  lua_sethook(state_, nullptr, 0, 0);
  heal();
}

// In the middle of anything: signal handler or allocator. The hook is set anew, since LuaJIT's table of instructions
// may have been caught half changed.
#if defined(__GNUC__)
__attribute__((no_sanitize("thread")))
#endif
void Guard::stop(Reason reason) {
  if (reason_ == Reason::none) reason_ = reason;
  hooked_ = true;
  lua_sethook(state_, nullptr, 0, 0);
  lua_sethook(state_, &Guard::on_hook, LUA_MASKCOUNT, 1);
  if (live_) leave_compiled_code(SIGPROF);
}

// what scripts catch of it is raised again at their next instruction
void Guard::on_hook(lua_State* state, lua_Debug*) {
  Guard* const guard = running_here;
  if (guard == nullptr || guard->reason_ == Reason::none) {
    lua_sethook(state, nullptr, 0, 0);
    return;
  }
  if (!std::exchange(guard->fired_, true)) guard->note_place(state);
  lua_pushliteral(state, "stopped");
  lua_error(state);
}

void Guard::note_place(lua_State* state, int level) {
  stop_file_[0] = 0;
  stop_line_ = 0;
  if (!place_of(state, level) && state != state_) place_of(state_, 0);
}

// the nearest script: its source's name begins with @, those of the prelude do not
bool Guard::place_of(lua_State* state, int level) {
  lua_Debug at{};
  for (; level < 250 && lua_getstack(state, level, &at) != 0; level++) {
    lua_getinfo(state, "Sl", &at);
    if (at.source[0] != '@' || at.currentline <= 0) continue;
    std::strncpy(stop_file_, at.source + 1, sizeof stop_file_ - 1);
    stop_line_ = at.currentline;
    return true;
  }
  return false;
}

std::string Guard::memory_text() const {
  return fmt::format(
      "scripts may hold {} MB together, 16 MB in one piece; keep less, and let go (= nil) of what is no longer needed",
      limits_.memory >> 20u);
}

std::string Guard::stop_text() const {
  if (reason_ == Reason::memory) return "stopped: " + memory_text();
  if (kind_ == Kind::run) {
    return fmt::format("stopped after {:g} s of computing; look for a loop without an end", limits_.run_ms / 1000);
  }
  return fmt::format(
      "stopped after {:g} ms of computing; look for a loop without an end, or spread the work over several steps",
      limits_.call_ms);
}

// A hook that was left by an error may leave its mark in the state, and no later script could be stopped then; an error
// that ends a coroutine takes the mark away.
void Guard::heal() {
  lua_State* const thread = lua_newthread(state_);
  lua_pushcfunction(thread, raise);
  lua_pushnil(thread);
  lua_resume(thread, 1);
  lua_pop(state_, 1);
}

void Guard::take_fault(int status, int function) {
  lua_State* const L = state_;
  if (reason_ == Reason::memory) memory_stop_ = true;
  fault_ = {};
  fault_.stopped = fired_;
  if (fired_ && (status == 0 || !lua_istable(L, -1))) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, stopped_fault_);
    lua_pcall(L, 0, 1, 0);
  }
  const auto text_at_top = [&] {
    std::size_t length = 0;
    const char* const text = lua_tolstring(L, -1, &length);
    return text == nullptr ? std::string() : std::string(text, length);
  };
  if (lua_istable(L, -1)) {
    const int table = lua_gettop(L);
    lua_getfield(L, table, "line");
    fault_.line = static_cast<int>(lua_tointeger(L, -1));
    lua_getfield(L, table, "file");
    fault_.file = text_at_top();
    lua_getfield(L, table, "text");
  }
  fault_.text = text_at_top();
  if (overflowed_ && stop_line_ != 0) {
    fault_.file = stop_file_;
    fault_.line = stop_line_;
    fault_.text = fmt::format("{}:{}: stack overflow", fault_.file, fault_.line);
  }
  if (fault_.text.empty()) fault_.text = "an error without text";
  if (fault_.line == 0) place_at_function(function);
  // what LuaJIT says of one piece that is refused
  constexpr std::string_view kRefused = "not enough memory";
  const std::string_view first_line = std::string_view(fault_.text).substr(0, fault_.text.find('\n'));
  if (first_line.ends_with(kRefused)) fault_.text.insert(first_line.size(), ": " + memory_text());
}

// The message handler: calls that of the prelude, for which a stack that has overflowed has no room left.
int Guard::on_error(lua_State* state) {
  auto& guard = *static_cast<Guard*>(lua_touserdata(state, lua_upvalueindex(1)));
  if (lua_type(state, 1) == LUA_TSTRING && std::string_view(lua_tostring(state, 1)).ends_with("stack overflow")) {
    guard.overflowed_ = true;
    guard.note_place(state, 2);  // 0 is this function, 1 the one that found no room to begin
    return 1;
  }
  lua_pushvalue(state, lua_upvalueindex(2));
  lua_insert(state, 1);
  lua_call(state, 1, 1);
  return 1;
}

// A function that ended in a call of ours has left the stack, and LuaJIT tells no place when it finds no room: then it
// is where the called function begins.
void Guard::place_at_function(int function) {
  lua_Debug at{};
  lua_pushvalue(state_, function);
  lua_getinfo(state_, ">S", &at);
  if (at.source[0] != '@') return;
  fault_.file = at.source + 1;
  fault_.line = at.linedefined;
  fault_.text = fmt::format("{}:{}: {}", fault_.file, fault_.line, fault_.text);
}

}  // namespace limber
