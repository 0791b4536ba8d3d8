// The counting allocator around LuaJIT's own.
#include "script/memory.h"

#include <algorithm>

#include <lua.hpp>

#include "base/key_bytes.h"

namespace limber {

namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20u;
constexpr std::size_t kLarge = 16 * kMegabyte;       // one such request stops the script that makes it
constexpr std::size_t kImpossible = 32 * kMegabyte;  // one such request is refused
constexpr std::size_t kMuch = 256 * kMegabyte;       // what a call may add that was good before
constexpr std::size_t kAlarmStep = kMegabyte / 4;
// What a call may add when the memory is full: less and less the more is held beyond the cap, so that the one who takes
// most is stopped first; nothing at three times the cap.
constexpr std::size_t kHeadroom = kMegabyte;
constexpr std::size_t kLeast = 4096;

std::size_t headroom(std::size_t used, std::size_t cap) {
  if (used <= cap) return kHeadroom;
  if (used > 3 * cap) return 0;
  const double beyond = static_cast<double>(used - cap) / static_cast<double>(cap);
  return beyond < 1 ? std::max(kLeast, static_cast<std::size_t>(kHeadroom * (1 - beyond))) : kLeast;
}

}  // namespace

void Memory::attach(lua_State* state) {
  used_ = static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNT, 0)) * 1024 +
          static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNTB, 0));
  inner_ = lua_getallocf(state, &inner_self_);
  lua_setallocf(state, &Memory::allocate, this);
}

void Memory::detach(lua_State* state) { lua_setallocf(state, inner_, inner_self_); }

void Memory::pass(KeyBytes& key) { key.pass(used_); }

void Memory::begin_call(bool free) {
  if (free) {
    end_call();
    alarm_ = used_ + kMuch;
    return;
  }
  in_call_ = true;
  alarm_ = std::max(cap_, used_ + headroom(used_, cap_));
}

void* Memory::allocate(void* self, void* block, std::size_t before, std::size_t after) {
  Memory& m = *static_cast<Memory*>(self);
  const bool large = after >= kLarge && after > before && m.in_call_;
  if (large && after >= kImpossible) return nullptr;
  void* const got = m.inner_(m.inner_self_, block, before, after);
  if (got == nullptr && after != 0) return nullptr;
  m.used_ += after - before;
  if (m.used_ > m.alarm_ || large) {
    m.alarm_ = m.used_ + kAlarmStep;
    m.full_(m.owner_);
  }
  return got;
}

}  // namespace limber
