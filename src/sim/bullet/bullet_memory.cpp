// Bullet's two allocator hooks. A word before each block identifies its owner: an arena (lowest bit set), or the heap
// (address of the malloc block, as in Bullet's own allocator).
#include "sim/bullet/bullet_memory.h"

#include <cstdint>
#include <cstdlib>

#include "base/memory/memcheck.h"
#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

namespace {

constexpr std::size_t kLabelSize = 16;

thread_local BulletMemory* current_memory = nullptr;

// labels are addresses stored as integers; the lowest bit is set for an arena
// NOLINTBEGIN(performance-no-int-to-ptr)
std::uintptr_t& label_of(void* block) { return static_cast<std::uintptr_t*>(block)[-1]; }

void* allocate_from_heap(std::size_t size, std::size_t alignment) {
  void* const memory = std::malloc(size + sizeof(void*) + alignment - 1);
  if (memory == nullptr) return nullptr;
  const std::uintptr_t min_address = reinterpret_cast<std::uintptr_t>(memory) + sizeof(void*);
  auto* const block = reinterpret_cast<void*>((min_address + alignment - 1) / alignment * alignment);
  label_of(block) = reinterpret_cast<std::uintptr_t>(memory);
  return block;
}

void* bullet_allocate(std::size_t size, int alignment) {
  const auto aligned = static_cast<std::size_t>(alignment);
  if (current_memory == nullptr || aligned > kLabelSize) return allocate_from_heap(size, aligned);
  Arena& arena = current_memory->arena();
  auto* const memory = static_cast<std::byte*>(arena.allocate(size + kLabelSize));
  if (memory == nullptr) return allocate_from_heap(size, aligned);
  void* const block = memory + kLabelSize;
  mark_uninitialized(block, size);
  label_of(block) = reinterpret_cast<std::uintptr_t>(&arena) | 1u;
  return block;
}

void bullet_free(void* block) {
  if (block == nullptr) return;
  const std::uintptr_t label = label_of(block);
  if ((label & 1u) != 0) {
    reinterpret_cast<Arena*>(label & ~std::uintptr_t{1})->free(static_cast<std::byte*>(block) - kLabelSize);
  } else {
    std::free(reinterpret_cast<void*>(label));
  }
}
// NOLINTEND(performance-no-int-to-ptr)

}  // namespace

BulletMemory::BulletMemory() {
  [[maybe_unused]] static const bool installed = [] {
    btAlignedAllocSetCustomAligned(&bullet_allocate, &bullet_free);
    return true;
  }();
}

BulletMemory* BulletMemory::current() { return current_memory; }

BulletMemory::Scope::Scope(BulletMemory* memory) : previous_(current_memory) { current_memory = memory; }
BulletMemory::Scope::~Scope() { current_memory = previous_; }

}  // namespace limber::sim::bullet
