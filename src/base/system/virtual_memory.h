// Virtual memory: reserves address ranges and commits memory in parts of them. [any]
#pragma once

#include <cstddef>
#include <cstdint>

namespace limber::system {

/// Returns the page size in bytes: 4096, or on arm64 16384 or 65536.
std::size_t page_size();

/// Reserves a page-aligned address range without memory, at `hint` if it is not 0 and free, else anywhere, until
/// release_memory(). Returns null on failure.
std::byte* reserve_memory(std::size_t bytes, std::uintptr_t hint = 0);
/// Makes a page-aligned part of a reserved range readable and writable. False if there is not enough memory.
bool commit_memory(std::byte* begin, std::size_t bytes);
void release_memory(std::byte* begin, std::size_t bytes);

/// Requests large pages for a page-aligned range; this affects performance only.
void prefer_large_pages(std::byte* begin, std::size_t bytes);

}  // namespace limber::system
