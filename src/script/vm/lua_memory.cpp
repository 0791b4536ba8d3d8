// The counting allocator, a wrapper around LuaJIT's own.
#include "script/vm/lua_memory.h"

#include <algorithm>

#include <lua.hpp>

#include "base/memory/archive.h"

namespace limber::script {

namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20u;
constexpr std::size_t kStopRequest = 16 * kMegabyte;       // a request of this size stops the script
constexpr std::size_t kRejectedRequest = 32 * kMegabyte;   // a request of this size is rejected
constexpr std::size_t kReplayAllowance = 256 * kMegabyte;  // allowance for a call that is repeated
constexpr std::size_t kAlarmStep = kMegabyte / 4;
// Amount that a call may allocate when the memory is full: decreases the more the cap is exceeded, so that the script
// that allocates most is stopped first; 0 at three times the cap.
constexpr std::size_t kHeadroom = kMegabyte;
constexpr std::size_t kMinHeadroom = 4096;

std::size_t headroom(std::size_t used, std::size_t cap) {
  if (used <= cap) return kHeadroom;
  if (used > 3 * cap) return 0;
  const double beyond = static_cast<double>(used - cap) / static_cast<double>(cap);
  return beyond < 1 ? std::max(kMinHeadroom, static_cast<std::size_t>(kHeadroom * (1 - beyond))) : kMinHeadroom;
}

}  // namespace

void LuaMemory::attach(lua_State* state) {
  used_ = static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNT, 0)) * 1024 +
          static_cast<std::size_t>(lua_gc(state, LUA_GCCOUNTB, 0));
  base_allocator_ = lua_getallocf(state, &base_allocator_data_);
  lua_setallocf(state, &LuaMemory::allocate, this);
}

void LuaMemory::detach(lua_State* state) { lua_setallocf(state, base_allocator_, base_allocator_data_); }

void LuaMemory::serialize(Archive& archive) { archive.serialize(used_); }

void LuaMemory::begin_call(bool resimulating) {
  if (resimulating) {
    end_call();
    alarm_at_ = used_ + kReplayAllowance;
    return;
  }
  in_call_ = true;
  alarm_at_ = std::max(cap_, used_ + headroom(used_, cap_));
}

void* LuaMemory::allocate(void* self, void* block, std::size_t before, std::size_t after) {
  LuaMemory& m = *static_cast<LuaMemory*>(self);
  const bool large = after >= kStopRequest && after > before && m.in_call_;
  if (large && after >= kRejectedRequest) return nullptr;
  void* const result = m.base_allocator_(m.base_allocator_data_, block, before, after);
  if (result == nullptr && after != 0) return nullptr;
  m.used_ += after - before;
  if (m.used_ > m.alarm_at_ || large) {
    m.alarm_at_ = m.used_ + kAlarmStep;
    m.on_full_(m.owner_);
  }
  return result;
}

}  // namespace limber::script
