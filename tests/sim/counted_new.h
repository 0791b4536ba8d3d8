// How often this test program has called operator new.
#pragma once

#include <cstddef>

namespace limber::test {

std::size_t allocations();

}  // namespace limber::test
