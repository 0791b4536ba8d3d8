// Address ranges that are reserved as a whole and backed by memory in parts. [any]
#pragma once

#include <cstddef>

namespace limber::system {

/// Reserves addresses without memory; null: the system has none. They belong to the caller until release_memory().
std::byte* reserve_memory(std::size_t bytes);
/// Makes a part of a reserved range readable and writable; false: there is not enough memory.
bool commit_memory(std::byte* place, std::size_t bytes);
void release_memory(std::byte* place, std::size_t bytes);

/// Asks for large pages from `place` on, which must be the start of a page. Without them only speed differs.
void prefer_large_pages(std::byte* place, std::size_t bytes);

}  // namespace limber::system
