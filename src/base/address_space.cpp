// The system's memory, with wishes where the system's own choice is too high.
#include "base/address_space.h"

#include "base/system/virtual_memory.h"

namespace limber {

namespace {

// Wishes lie this far apart, from the top downwards.
constexpr std::uintptr_t kStep = std::uintptr_t{1} << 40;

}  // namespace

AddressSpace& AddressSpace::of_system() {
  static AddressSpace system;
  return system;
}

std::size_t AddressSpace::page() const { return system::page_size(); }

std::byte* AddressSpace::reserve(std::size_t size) {
  for (std::uintptr_t wish = 0; wish < kEnd; wish = wish == 0 ? kStep : wish + kStep) {
    // the system's own choice first, then from 2^47 downwards
    std::byte* const got = map(wish == 0 ? 0 : kEnd - wish, size);
    if (got == nullptr) return nullptr;
    if (reinterpret_cast<std::uintptr_t>(got) + size <= kEnd) return got;
    release(got, size);
  }
  return nullptr;
}

std::byte* AddressSpace::map(std::uintptr_t wish, std::size_t size) { return system::reserve_memory(size, wish); }

bool AddressSpace::open(std::byte* begin, std::size_t size) { return system::commit_memory(begin, size); }

void AddressSpace::release(std::byte* begin, std::size_t size) { system::release_memory(begin, size); }

std::byte* next_page(std::byte* place, std::size_t page) {
  const std::size_t behind = reinterpret_cast<std::uintptr_t>(place) % page;
  return behind == 0 ? place : place + (page - behind);
}

}  // namespace limber
