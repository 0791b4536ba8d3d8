// Address ranges that are reserved as a whole and backed by memory in parts. [any]
#pragma once

#include <cstddef>
#include <cstdint>

namespace limber::system {

/// Bytes of a page: 4096, or on arm64 16384 or 65536.
std::size_t page_size();

/// Reserves addresses without memory, at `wish` if it is not 0 and free, else where the system prefers; null: the
/// system has none. They begin at a page and belong to the caller until release_memory().
std::byte* reserve_memory(std::size_t bytes, std::uintptr_t wish = 0);
/// Makes a part of a reserved range, from the start of a page on, readable and writable; false: there is not enough
/// memory.
bool commit_memory(std::byte* place, std::size_t bytes);
void release_memory(std::byte* place, std::size_t bytes);

/// Asks for large pages from `place` on, which must be the start of a page. Without them only speed differs.
void prefer_large_pages(std::byte* place, std::size_t bytes);

}  // namespace limber::system
