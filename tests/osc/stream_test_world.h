// A hand-made snapshot for the stream tests and the benchmark: the blocks are not in the order of the bodies, and each
// number encodes its position.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/output/snapshot.h"

namespace limber::osc::test {

/// With gaps between the groups, so that wrong offsets are detected.
inline constexpr engine::TransientOffsets kTestOffsets = {1, 4, 9, 13, 0, 3};
inline constexpr std::uint32_t kTestBlock = 17;  ///< Numbers per joint.

/// Returns the number at `index` of the hand-made Snapshot::transient; exact as a float.
inline double test_number(std::size_t index) { return static_cast<double>(index % 100000) * 0.25 - 7; }

struct FakeBody {
  std::string name;
  std::uint32_t joints;
};

inline engine::Snapshot test_world(const std::vector<FakeBody>& bodies) {
  auto list = std::make_shared<engine::BodyList>();
  std::uint32_t total = 0;
  for (const FakeBody& b : bodies) total += b.joints;
  // the first body's first joint has the last block
  std::uint32_t block = total;
  for (const FakeBody& b : bodies) {
    engine::BodyEntry body;
    body.name = b.name;
    for (std::uint32_t j = 0; j < b.joints; j++) {
      body.joint_names.push_back("j" + std::to_string(j));
      body.joint_offsets.push_back(--block * kTestBlock);
    }
    list->bodies.push_back(std::move(body));
  }
  engine::Snapshot snapshot;
  snapshot.body_list = list;
  for (std::size_t i = 0; i < std::size_t{total} * kTestBlock; i++) snapshot.transient.push_back(test_number(i));
  return snapshot;
}

}  // namespace limber::osc::test
