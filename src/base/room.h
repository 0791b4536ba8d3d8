// Room for numbers before they come, so that no step waits for memory. [any]
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace limber {

/// Room for so many, or for twice what there was room for: sizes that creep up do not allocate each time.
template <class T>
void make_room(std::vector<T>& things, std::size_t count) {
  if (count > things.capacity()) things.reserve(std::max(count, 2 * things.capacity()));
}

/// The same where nothing is kept, in memory that the system has given already: to give it takes microseconds a page.
template <class T>
void take_room(std::vector<T>& things, std::size_t count) {
  if (count > things.capacity()) things.resize(std::max(count, 2 * things.capacity()));
  things.clear();
}

}  // namespace limber
