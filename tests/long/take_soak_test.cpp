// Recorded and replayed soak tests: many seeds, and one of ten minutes. A list of actions that diverges is minimized.
// LIMBER_SOAK_SEED and LIMBER_SOAK_COUNT select other seeds.
#include <cstdlib>

#include "engine/soak.h"

namespace limber::engine::test {
namespace {

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

TEST(LongTakeSoak, ManySeedsReplayExactly) {
  const std::uint64_t first = number_of("LIMBER_SOAK_SEED", 100);
  const std::uint64_t count = number_of("LIMBER_SOAK_COUNT", 40);
  for (std::uint64_t seed = first; seed < first + count; seed++) {
    expect_soaks(static_cast<int>(number_of("LIMBER_SOAK_TICKS", 600)), seed);
    if (HasFailure()) return;
  }
}

// in parts of a minute, so that a diverging list is minimized quickly
TEST(LongTakeSoak, TenMinutesReplayExactly) {
  for (std::uint64_t seed = 1; seed <= 10; seed++) expect_soaks(3600, seed);
}

}  // namespace
}  // namespace limber::engine::test
