// WorldCheckpoint: the complete state of a world between two ticks. Restoring it reproduces all further ticks bit for
// bit, as long as nothing was added or removed in the meantime. [sim]
#pragma once

#include <cstdint>

#include "base/memory/archive.h"
#include "base/memory/page_store.h"

namespace limber::sim {

class World;

class WorldCheckpoint {
 public:
  /// Captures the world in pages that are shared with `previous`, an older checkpoint of it, or null. `scratch` is a
  /// reusable buffer.
  void capture(World& world, PageStore& pages, const WorldCheckpoint* previous, Archive& scratch);
  /// Restores the captured state. The structure must be the same as at the capture: equal Store::structure_version(),
  /// and equal numbers of children in compound shapes. Pure counters (steps, versions, calls) are not restored.
  void restore(World& world, const PageStore& pages, Archive& scratch) const;
  /// Returns its pages to the page store.
  void release(PageStore& pages);

 private:
  PageStore::PageList bullet_, persistent_, transient_, objects_;
  std::size_t objects_size_ = 0;
};

}  // namespace limber::sim
