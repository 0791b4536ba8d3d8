// Team: each piece once, whoever takes it, round after round. Meant for the thread sanitizer too.
#include "base/team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cfenv>
#include <thread>
#include <vector>

#include "base/fixed_math.h"

namespace limber {
namespace {

TEST(Team, EachPieceIsDoneOnceByAMember) {
  for (const int members : {1, 2, 3, 8}) {
    Team team(members);
    EXPECT_EQ(team.members(), members);
    // plain numbers: what a member wrote must be there when run() returns
    std::vector<int> done(100), by(100, -1);
    for (int round = 1; round <= 2000; round++) {
      const int pieces = round % 101;
      team.run(pieces, [&](int piece, int member) {
        done[static_cast<std::size_t>(piece)]++;
        by[static_cast<std::size_t>(piece)] = member;
      });
    }
    for (int piece = 0; piece < 100; piece++) {
      int rounds = 0;
      for (int round = 1; round <= 2000; round++) rounds += round % 101 > piece ? 1 : 0;
      EXPECT_EQ(done[static_cast<std::size_t>(piece)], rounds) << members << " " << piece;
      EXPECT_GE(by[static_cast<std::size_t>(piece)], 0);
      EXPECT_LT(by[static_cast<std::size_t>(piece)], members);
    }
  }
}

TEST(Team, EachMemberHasWhatIsItsOwn) {
  Team team(4);
  std::vector<long> sum(4);
  for (int round = 0; round < 500; round++) {
    team.run(50, [&](int piece, int member) { sum[static_cast<std::size_t>(member)] += piece; });
  }
  EXPECT_EQ(sum[0] + sum[1] + sum[2] + sum[3], 500L * 50 * 49 / 2);
}

TEST(Team, WithoutWorkItEnds) {
  for (int i = 0; i < 50; i++) Team(8).run(0, [](int, int) { ADD_FAILURE(); });
}

TEST(Team, WhoIsRousedForNothingDoesNothing) {
  Team team(3);
  int sum = 0;
  for (int round = 0; round < 500; round++) {
    team.rouse();
    std::atomic<int> done{0};
    if (round % 3 != 0) team.run(5, [&](int piece, int) { done += piece; });
    sum += done;
  }
  EXPECT_EQ(sum, 333 * (0 + 1 + 2 + 3 + 4));
}

// every piece waits for another member's: all of them must be at work at once, and each begins with its own part
TEST(Team, MembersWorkSideBySide) {
  constexpr int kMembers = 3;
  Team team(kMembers);
  for (int round = 0; round < 20; round++) {
    std::atomic<int> here{0};
    team.run(kMembers, [&](int piece, int member) {
      EXPECT_EQ(piece, member);
      here++;
      while (here < kMembers) std::this_thread::yield();
    });
    EXPECT_EQ(here, kMembers);
  }
}

// A library may change the rounding of a thread, which the threads that it starts inherit.
TEST(Team, MembersRoundToNearest) {
  constexpr int kMembers = 3;
  std::fesetround(FE_UPWARD);
  Team team(kMembers);
  fixed::reset_arithmetic();
  std::atomic<int> here{0};
  std::array<bool, kMembers> exact{};
  team.run(kMembers, [&](int piece, int) {
    here++;
    while (here < kMembers) std::this_thread::yield();
    exact.at(static_cast<std::size_t>(piece)) = fixed::is_arithmetic_exact();
  });
  EXPECT_EQ(exact, (std::array<bool, kMembers>{true, true, true}));
}

}  // namespace
}  // namespace limber
