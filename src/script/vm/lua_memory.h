// LuaMemory: an allocator that counts the memory of a Lua state and signals when a running script has used too much. It
// never rejects small requests, because LuaJIT aborts the program if some of them fail. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

struct lua_State;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::script {

class LuaMemory {
 public:
  /// `cap`: bytes that scripts may use. `full` is called inside the allocator during a call.
  LuaMemory(std::size_t cap, void (*full)(void* owner), void* owner) : cap_(cap), on_full_(full), owner_(owner) {}

  /// Installs the counting allocator in a state, and removes it before the state is closed.
  void attach(lua_State* state);
  void detach(lua_State* state);

  /// Monitors the allocations between these two calls. `resimulating`: the call is known to succeed, so only an
  /// amount far above normal calls triggers `full`.
  void begin_call(bool resimulating = false);
  void end_call() {
    alarm_at_ = kNever;
    in_call_ = false;
  }

  /// For a checkpoint.
  void serialize(Archive& archive);

  /// Sets the cap, effective from the next call.
  void set_cap(std::size_t cap) { cap_ = cap; }
  std::size_t used() const { return used_; }
  std::size_t cap() const { return cap_; }

 private:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  static void* allocate(void* self, void* block, std::size_t before, std::size_t after);

  std::size_t cap_;
  void (*on_full_)(void* owner);
  void* owner_;
  void* (*base_allocator_)(void* self, void* block, std::size_t before, std::size_t after) = nullptr;
  void* base_allocator_data_ = nullptr;
  std::size_t used_ = 0;
  std::size_t alarm_at_ = kNever;
  bool in_call_ = false;
};

}  // namespace limber::script
