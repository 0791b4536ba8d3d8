// Bullet's two hooks. A word before each block tells whose it is: an arena, marked by its lowest bit, or the heap, by
// the block's own address there, as Bullet's own allocator has it.
#include "sim/bullet_memory.h"

#include <cstdint>
#include <cstdlib>

#include "base/memcheck.h"
#include "sim/bullet.h"

namespace limber {

namespace {

constexpr std::size_t kLabel = 16;

thread_local BulletMemory* here = nullptr;

// addresses are kept as numbers: the lowest bit of a label tells an arena from the heap
// NOLINTBEGIN(performance-no-int-to-ptr)
std::uintptr_t& label_of(void* block) { return static_cast<std::uintptr_t*>(block)[-1]; }

void* take_from_heap(std::size_t size, std::size_t alignment) {
  void* const got = std::malloc(size + sizeof(void*) + alignment - 1);
  if (got == nullptr) return nullptr;
  const std::uintptr_t least = reinterpret_cast<std::uintptr_t>(got) + sizeof(void*);
  auto* const block = reinterpret_cast<void*>((least + alignment - 1) / alignment * alignment);
  label_of(block) = reinterpret_cast<std::uintptr_t>(got);
  return block;
}

void* take(std::size_t size, int alignment) {
  const auto aligned = static_cast<std::size_t>(alignment);
  if (here == nullptr || aligned > kLabel) return take_from_heap(size, aligned);
  Arena& arena = here->arena();
  auto* const got = static_cast<std::byte*>(arena.allocate(size + kLabel));
  if (got == nullptr) return take_from_heap(size, aligned);
  void* const block = got + kLabel;
  mark_uninitialized(block, size);
  label_of(block) = reinterpret_cast<std::uintptr_t>(&arena) | 1u;
  return block;
}

void give_back(void* block) {
  if (block == nullptr) return;
  const std::uintptr_t label = label_of(block);
  if ((label & 1u) != 0) {
    reinterpret_cast<Arena*>(label & ~std::uintptr_t{1})->free(static_cast<std::byte*>(block) - kLabel);
  } else {
    std::free(reinterpret_cast<void*>(label));
  }
}
// NOLINTEND(performance-no-int-to-ptr)

}  // namespace

BulletMemory::BulletMemory() {
  [[maybe_unused]] static const bool asked = [] {
    btAlignedAllocSetCustomAligned(&take, &give_back);
    return true;
  }();
}

BulletMemory* BulletMemory::current() { return here; }

BulletMemory::Scope::Scope(BulletMemory* memory) : before_(here) { here = memory; }
BulletMemory::Scope::~Scope() { here = before_; }

}  // namespace limber
