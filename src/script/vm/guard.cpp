// Guarded calls. Stopping compiled loops: Debian's build of LuaJIT does not check hooks in compiled code, but once its
// profiler is started in mode 'l', each compiled loop checks a flag. Setting that flag makes compiled code return to
// the interpreter, where a hook with count 1 raises the error, repeatedly until the call has ended.
#include "script/vm/guard.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <lua.hpp>

#include "base/check.h"
#include "base/memory/archive.h"
#include "base/system/signals.h"
#include "script/vm/call_log.h"

namespace limber::script {

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
// polling interval of the watchdog, ns: a tenth of the budget of a call, between 0.2 and 4 ms
std::int64_t poll_interval(const ScriptLimits& limits) {
  return std::clamp(static_cast<std::int64_t>(limits.call_ms * kMillisecond / 10), std::int64_t{200'000},
                    4 * kMillisecond);
}

thread_local Guard* current_guard = nullptr;

// the profiler exists once per process: its owner is the guard whose state has the JIT compiler
std::atomic<Guard*> jit_guard{nullptr};
void (*leave_compiled_code)(int) = nullptr;  // the profiler's signal handler, which sets the flag

void no_profile(void*, lua_State*, int, int) {}

int raise(lua_State* state) { return lua_error(state); }

// LuaJIT 2.1.0-beta3 on arm64 (Debian 12) compiles a multiplication followed by an addition to one fused instruction,
// which rounds differently from its interpreter, so scripts are only interpreted there.
bool compiles_like_interpreter() {
#if defined(__aarch64__)
  return std::string_view(LUAJIT_VERSION) != "LuaJIT 2.1.0-beta3";
#else
  return true;
#endif
}

// sets the JIT thresholds for loop iterations, function calls, and exits of compiled code
void set_hot_thresholds(lua_State* L, int rounds) {
  lua_getfield(L, LUA_REGISTRYINDEX, "_LOADED");
  lua_getfield(L, -1, "jit.opt");
  lua_getfield(L, -1, "start");
  lua_pushfstring(L, "hotloop=%d", rounds);
  lua_pushfstring(L, "hotexit=%d", rounds);
  lua_call(L, 2, 0);
  lua_pop(L, 2);
}

}  // namespace

Guard::Guard(lua_State* state, CallHooks& hooks, const ScriptLimits& limits)
    : state_(state),
      hooks_(hooks),
      limits_(limits),
      memory_(
          limits.memory, [](void* guard) { static_cast<Guard*>(guard)->stop(Reason::memory); }, this),
      watchdog_(Watchdog::instance()) {
  memory_.attach(state_);
  watch_.owner = this;
  watch_.stop = [](Watch& watch) { static_cast<Guard*>(watch.owner)->stop(Reason::time); };
  watchdog_->add(watch_, poll_interval(limits));
  luaJIT_setmode(state_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
}

Guard::~Guard() {
  watchdog_->remove(watch_);
  disable_jit();
  memory_.detach(state_);
}

void Guard::set_limits(const ScriptLimits& limits) {
  limits_ = limits;
  memory_.set_cap(limits.memory);
  watchdog_->remove(watch_);
  watchdog_->add(watch_, poll_interval(limits));
}

void Guard::set_functions(const Functions& functions) {
  functions_ = functions;
  lua_pushlightuserdata(state_, this);
  lua_rawgeti(state_, LUA_REGISTRYINDEX, functions.handler);
  lua_pushcclosure(state_, &Guard::on_error, 2);
  functions_.handler = luaL_ref(state_, LUA_REGISTRYINDEX);
}

bool Guard::enable_jit() {
  if (jit_enabled_) return true;
  Guard* expected = nullptr;
  if (!jit_guard.compare_exchange_strong(expected, this)) return false;
  // only its signal handler is needed, not its timer
  leave_compiled_code =
      system::preserve_profile_signal([this] { luaJIT_profile_start(state_, "li1000000000", no_profile, nullptr); });
  if (limits_.compiled && compiles_like_interpreter()) {
    luaJIT_setmode(state_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_ON);
    if (limits_.hot_loop > 0) set_hot_thresholds(state_, limits_.hot_loop);
  }
  jit_enabled_ = true;
  return true;
}

void Guard::disable_jit() {
  if (!jit_enabled_) return;
  jit_enabled_ = false;
  (void)system::preserve_profile_signal([this] { luaJIT_profile_stop(state_); });
  luaJIT_setmode(state_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
  jit_guard = nullptr;
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
  if (kind == Kind::call && call_log_ != nullptr && call_log_->skips_next()) return skip_call(arguments);
  // push the function again, for faults without a place, and the message handler
  const int function = lua_gettop(L) - arguments;
  lua_pushvalue(L, function);
  lua_insert(L, function);
  lua_rawgeti(L, LUA_REGISTRYINDEX, functions_.handler);
  lua_insert(L, function + 1);
  begin(kind);
  const int status = lua_pcall(L, arguments, results, function + 1);
  end();
  const bool success = status == 0 && !stop_.error_raised;
  if (success) {
    lua_remove(L, function + 1);
    lua_remove(L, function);
  } else {
    capture_fault(status, function);
    lua_settop(L, function - 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, functions_.failed);
    lua_pcall(L, 0, 0, 0);
    lua_settop(L, function - 1);
    if (fault_.stopped && kind == Kind::call && call_log_ != nullptr)
      call_log_->record_stop(fault_.file, fault_.line, fault_.text);
  }
  if (kind == Kind::call) hooks_.end_call(success);
  return success;
}

// repeats the failure of a call that was stopped when the take was recorded
bool Guard::skip_call(int arguments) {
  hooks_.begin_call();
  const StoppedCall& stop = call_log_->skip();
  fault_ = {stop.file, stop.line, stop.text, true};
  lua_settop(state_, lua_gettop(state_) - arguments - 1);
  lua_rawgeti(state_, LUA_REGISTRYINDEX, functions_.failed);
  lua_pcall(state_, 0, 0, 0);
  hooks_.end_call(false);
  return false;
}

void Guard::Stop::begin_call() {
  error_raised = overflowed = false;
  hook_set = false;
  reason = Reason::none;
}

void Guard::begin(Kind kind) {
  kind_ = kind;
  running_ = true;
  stop_.begin_call();
  if (kind == Kind::call) {
    if (call_log_ != nullptr) call_log_->count_call();
    hooks_.begin_call();
  }
  memory_.begin_call(resimulating_);
  current_guard = this;
  const double budget = resimulating_ ? limits_.replay_ms : kind == Kind::call ? limits_.call_ms : limits_.run_ms;
  watch_.begin(static_cast<std::int64_t>(budget * kMillisecond));
}

void Guard::serialize(Archive& archive) {
  memory_.serialize(archive);
  archive.serialize(memory_stop_);
}

bool Guard::next_call(bool& changed) {
  if (call_log_ != nullptr && call_log_->skips_next()) return false;
  // later stop requests for the previous call have no effect; earlier ones are seen below
  watch_.next_call();
  if (stop_.reason != Reason::none || (memory_.used() > memory_.cap() / 2 && !resimulating_)) return false;
  if (call_log_ != nullptr) call_log_->count_call();
  if (hooks_.next_call()) changed = true;
  memory_.begin_call(resimulating_);
  return true;
}

void Guard::attribute_to_function() {
  if (fault_.line == 0) set_place_to_function(lua_gettop(state_));
}

// Needed because LuaJIT calls no message handler if the stack overflows while execution leaves a compiled trace.
void Guard::attribute_to_file(std::string_view name) {
  if (fault_.line != 0 || !fault_.file.empty()) return;
  fault_.file = name;
  fault_.text = fmt::format("{}: {}", name, fault_.text);
}

void Guard::end() {
  watch_.end();
  memory_.end_call();
  current_guard = nullptr;
  running_ = false;
  if (!stop_.hook_set) return;
  lua_sethook(state_, nullptr, 0, 0);
  clear_hook_flag();
}

// Runs in a signal handler or in the allocator, at any point of execution. Removes the hook before setting it, since
// the signal may have interrupted LuaJIT's update of its dispatch table.
#if defined(__GNUC__)
__attribute__((no_sanitize("thread")))
#endif
void Guard::stop(Reason reason) {
  if (stop_.reason == Reason::none) stop_.reason = reason;
  stop_.hook_set = true;
  lua_sethook(state_, nullptr, 0, 0);
  lua_sethook(state_, &Guard::on_hook, LUA_MASKCOUNT, 1);
  if (jit_enabled_) leave_compiled_code(SIGPROF);
}

// an error caught by the script is raised again at its next instruction
void Guard::on_hook(lua_State* state, lua_Debug*) {
  Guard* const guard = current_guard;
  if (guard == nullptr || guard->stop_.reason == Reason::none) {
    lua_sethook(state, nullptr, 0, 0);
    return;
  }
  if (!std::exchange(guard->stop_.error_raised, true)) guard->record_place(state);
  lua_pushliteral(state, "stopped");
  lua_error(state);
}

void Guard::record_place(lua_State* state, int level) {
  stop_.file[0] = 0;
  stop_.line = 0;
  if (!stop_.find_place(state, level) && state != state_) stop_.find_place(state_, 0);
}

// finds the innermost script function: sources of scripts begin with @, those of the prelude do not
bool Guard::Stop::find_place(lua_State* state, int level) {
  lua_Debug at{};
  for (; level < 250 && lua_getstack(state, level, &at) != 0; level++) {
    lua_getinfo(state, "Sl", &at);
    if (at.source[0] != '@' || at.currentline <= 0) continue;
    std::strncpy(file, at.source + 1, sizeof file - 1);
    line = at.currentline;
    return true;
  }
  return false;
}

std::string Guard::memory_text() const {
  return fmt::format(
      "scripts can use {} MB in total, 16 MB in one allocation; store less, and release unused data (= nil)",
      limits_.memory >> 20u);
}

std::string Guard::stop_text() const {
  if (stop_.reason == Reason::memory) return "stopped: " + memory_text();
  if (kind_ == Kind::run) {
    return fmt::format("stopped after {:g} s of computing; check for an infinite loop", limits_.run_ms / 1000);
  }
  return fmt::format(
      "stopped after {:g} ms of computing; check for an infinite loop, or spread the work over several steps",
      limits_.call_ms);
}

// If an error leaves the hook, LuaJIT's flag for an active hook may stay set, and later scripts could not be stopped.
// An error that ends a coroutine clears the flag.
void Guard::clear_hook_flag() {
  lua_State* const thread = lua_newthread(state_);
  lua_pushcfunction(thread, raise);
  lua_pushnil(thread);
  lua_resume(thread, 1);
  lua_pop(state_, 1);
}

void Guard::capture_fault(int status, int function) {
  lua_State* const L = state_;
  if (stop_.reason == Reason::memory) memory_stop_ = true;
  fault_ = {};
  fault_.stopped = stop_.error_raised;
  if (stop_.error_raised && (status == 0 || !lua_istable(L, -1))) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, functions_.stopped_fault);
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
  if (stop_.overflowed && stop_.line != 0) {
    fault_.file = stop_.file;
    fault_.line = stop_.line;
    fault_.text = fmt::format("{}:{}: stack overflow", fault_.file, fault_.line);
  }
  if (fault_.text.empty()) fault_.text = "an error without a message";
  if (fault_.line == 0) set_place_to_function(function);
  // LuaJIT's message when a single allocation was rejected
  constexpr std::string_view kOutOfMemory = "not enough memory";
  const std::string_view first_line = std::string_view(fault_.text).substr(0, fault_.text.find('\n'));
  if (first_line.ends_with(kOutOfMemory)) fault_.text.insert(first_line.size(), ": " + memory_text());
}

// The message handler. Calls the prelude's handler, except after a stack overflow, when it has no stack space left.
int Guard::on_error(lua_State* state) {
  auto& guard = *static_cast<Guard*>(lua_touserdata(state, lua_upvalueindex(1)));
  if (lua_type(state, 1) == LUA_TSTRING && std::string_view(lua_tostring(state, 1)).ends_with("stack overflow")) {
    guard.stop_.overflowed = true;
    guard.record_place(state, 2);  // 0 is this function, 1 the one that overflowed the stack
    return 1;
  }
  lua_pushvalue(state, lua_upvalueindex(2));
  lua_insert(state, 1);
  lua_call(state, 1, 1);
  return 1;
}

// Uses the start of the called function as place. Needed if the function ended in a call to C++ and has left the stack,
// and because LuaJIT gives no place when memory is exhausted.
void Guard::set_place_to_function(int function) {
  lua_Debug at{};
  lua_pushvalue(state_, function);
  lua_getinfo(state_, ">S", &at);
  if (at.source[0] != '@') return;
  fault_.file = at.source + 1;
  fault_.line = at.linedefined;
  fault_.text = fmt::format("{}:{}: {}", fault_.file, fault_.line, fault_.text);
}

}  // namespace limber::script
