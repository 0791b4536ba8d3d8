// MotionSurfaces: what is seen of a part, as triangles that other programs draw.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/snapshot.h"
#include "motion/motion.h"

namespace limber {

/// A plane has no end; it becomes a square of this edge, m.
inline constexpr double kPlaneEdge = 20;

class MotionSurfaces {
 public:
  /// The pieces of one part, with the colours of that moment. Parts that look alike get the same. Null: nothing is
  /// seen.
  std::shared_ptr<const Surfaces> of(const Snapshot& snapshot, std::span<const DrawnPiece> pieces);

 private:
  struct Known {
    std::shared_ptr<const Surfaces> surfaces;
    std::vector<std::shared_ptr<const MeshModel>> meshes;  // so that their addresses, which are in the key, stay theirs
  };
  std::map<std::string, Known> known_;  // by all that makes them
};

}  // namespace limber
