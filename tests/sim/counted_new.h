// Number of calls of operator new in this test program so far.
#pragma once

#include <cstddef>

namespace limber::sim::test {

std::size_t allocations();

}  // namespace limber::sim::test
