// Growth of large arrays by a quarter. [any]
#pragma once

#include <cstddef>
#include <vector>

namespace limber {

/// Reserves memory for `more` elements. Grows by a quarter instead of doubling, for arrays that are most of the memory.
template <class T>
void reserve_by_quarter(std::vector<T>& list, std::size_t more) {
  if (list.size() + more > list.capacity()) list.reserve(list.size() + list.size() / 4 + more);
}

}  // namespace limber
