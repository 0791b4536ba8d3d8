// A search survives many kills.
#include "app/evolve_kills.h"

namespace limber::app::test {
namespace {

TEST(LongEvolve, ArchiveIsTheSameAfterManyKills) {
  KilledSearch search(400);
  search.run_whole();
  search.run_with_killed_children(150);
  search.expect_same("children");
  search.run_with_killed_jobs(50);
  search.expect_same("jobs");
}

}  // namespace
}  // namespace limber::app::test
