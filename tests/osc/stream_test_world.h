// A snapshot made by hand for the stream tests and the benchmark: blocks in an order that is not the bodies', numbers
// that tell where they stand.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/snapshot.h"

namespace limber::osc_test {

/// Gaps between the groups, so that a wrong offset shows.
inline constexpr LiveOffsets kTestOffsets = {1, 4, 9, 13, 0, 3};
inline constexpr std::uint32_t kTestBlock = 17;  ///< Numbers per joint.

/// The number that stands at `index` in the hand-made Snapshot::live; exact as a float.
inline double test_number(std::size_t index) { return static_cast<double>(index % 100000) * 0.25 - 7; }

struct FakeBody {
  std::string name;
  std::uint32_t joints;
};

inline Snapshot test_world(const std::vector<FakeBody>& bodies) {
  auto roster = std::make_shared<Roster>();
  std::uint32_t total = 0;
  for (const FakeBody& b : bodies) total += b.joints;
  // the first body's first joint has the last block
  std::uint32_t block = total;
  for (const FakeBody& b : bodies) {
    RosterBody body;
    body.name = b.name;
    for (std::uint32_t j = 0; j < b.joints; j++) {
      body.joint_names.push_back("j" + std::to_string(j));
      body.joints.push_back(--block * kTestBlock);
    }
    roster->bodies.push_back(std::move(body));
  }
  Snapshot snapshot;
  snapshot.roster = roster;
  for (std::size_t i = 0; i < std::size_t{total} * kTestBlock; i++) snapshot.live.push_back(test_number(i));
  return snapshot;
}

}  // namespace limber::osc_test
