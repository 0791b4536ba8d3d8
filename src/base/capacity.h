// Reserves capacity of vectors in advance, so that steps do not allocate. [any]
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace limber {

/// Reserves capacity for `count` elements, at least doubling it if it is too small, so that a slowly growing size does
/// not allocate each time.
template <class T>
void reserve(std::vector<T>& things, std::size_t count) {
  if (count > things.capacity()) things.reserve(std::max(count, 2 * things.capacity()));
}

/// Like reserve(), but clears the vector and touches the new memory, so that page faults (microseconds each) happen
/// here.
template <class T>
void clear_and_reserve(std::vector<T>& things, std::size_t count) {
  if (count > things.capacity()) things.resize(std::max(count, 2 * things.capacity()));
  things.clear();
}

}  // namespace limber
