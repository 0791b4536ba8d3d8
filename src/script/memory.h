// Memory: counts what a Lua state holds, and tells when a running script has taken too much. It never refuses a small
// request: LuaJIT takes some in places where a refusal would end the program. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

struct lua_State;

namespace limber {

class KeyBytes;

class Memory {
 public:
  /// `cap`: bytes that scripts may hold. `full` is called inside the allocator, while a call runs.
  Memory(std::size_t cap, void (*full)(void* owner), void* owner) : cap_(cap), full_(full), owner_(owner) {}

  /// Puts the count between a state and its allocator, and takes it away again before the state is closed.
  void attach(lua_State* state);
  void detach(lua_State* state);

  /// Only what is taken between these two is watched.
  /// `free`: only what no good call takes, since it was good before.
  void begin_call(bool free = false);
  void end_call() {
    alarm_ = kNever;
    in_call_ = false;
  }

  /// For a key state.
  void pass(KeyBytes& key);

  /// From the next call on.
  void limit(std::size_t cap) { cap_ = cap; }
  std::size_t used() const { return used_; }
  std::size_t cap() const { return cap_; }

 private:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  static void* allocate(void* self, void* block, std::size_t before, std::size_t after);

  std::size_t cap_;
  void (*full_)(void* owner);
  void* owner_;
  void* (*inner_)(void* self, void* block, std::size_t before, std::size_t after) = nullptr;
  void* inner_self_ = nullptr;
  std::size_t used_ = 0;
  std::size_t alarm_ = kNever;
  bool in_call_ = false;
};

}  // namespace limber
