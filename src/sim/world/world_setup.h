// WorldSetup: the settings with which a world is created. [any]
#pragma once

#include <memory>

#include "base/threads/thread_pool.h"

namespace limber::sim {

/// Settings of a world.
struct WorldSetup {
  double broadphase_margin = 0.01;  ///< Margin of fattened bounding boxes, m.
  int solver_iterations = 50;
  std::shared_ptr<ThreadPool> thread_pool{};  ///< Threads that share the work of a step; the result doesn't depend on
                                              ///< them. Null: the calling thread only.
};

}  // namespace limber::sim
