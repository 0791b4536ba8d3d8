// Virtual memory of the system; retries with address hints if the system's own choice is too high.
#include "base/memory/address_space.h"

#include "base/system/virtual_memory.h"

namespace limber {

namespace {

// The distance between hints, from the top downwards.
constexpr std::uintptr_t kHintStep = std::uintptr_t{1} << 40;

}  // namespace

AddressSpace& AddressSpace::of_system() {
  static AddressSpace system;
  return system;
}

std::size_t AddressSpace::page_size() const { return system::page_size(); }

std::byte* AddressSpace::reserve(std::size_t size) {
  for (std::uintptr_t hint = 0; hint < kEnd; hint = hint == 0 ? kHintStep : hint + kHintStep) {
    // The system chooses first; then hints from 2^47 downwards.
    std::byte* const begin = map(hint == 0 ? 0 : kEnd - hint, size);
    if (begin == nullptr) return nullptr;
    if (reinterpret_cast<std::uintptr_t>(begin) + size <= kEnd) return begin;
    release(begin, size);
  }
  return nullptr;
}

std::byte* AddressSpace::map(std::uintptr_t hint, std::size_t size) { return system::reserve_memory(size, hint); }

bool AddressSpace::commit(std::byte* begin, std::size_t size) { return system::commit_memory(begin, size); }

void AddressSpace::release(std::byte* begin, std::size_t size) { system::release_memory(begin, size); }

std::byte* align_up(std::byte* address, std::size_t alignment) {
  const std::size_t remainder = reinterpret_cast<std::uintptr_t>(address) % alignment;
  return remainder == 0 ? address : address + (alignment - remainder);
}

}  // namespace limber
