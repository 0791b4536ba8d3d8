// MotionSurfaces: the visible surfaces of parts as triangle meshes, for exported motion.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/output/snapshot.h"
#include "export/motion.h"

namespace limber::app {

/// Edge of the square that represents an infinite plane, m.
inline constexpr double kPlaneEdge = 20;

/// Builds surfaces and shares equal ones.
class MotionSurfaces {
 public:
  /// Returns the surfaces of the instances of one part, with their current colors. Parts that look alike share them.
  /// Null if nothing is visible.
  std::shared_ptr<const exporter::Surfaces> surfaces_of(const engine::Snapshot& snapshot,
                                                        std::span<const engine::RenderInstance> instances);

 private:
  struct CacheEntry {
    std::shared_ptr<const exporter::Surfaces> surfaces;
    // keeps the meshes alive: their addresses are part of the key
    std::vector<std::shared_ptr<const model::MeshModel>> meshes;
  };
  std::map<std::string, CacheEntry> cache_;  // by everything that determines them
};

}  // namespace limber::app
