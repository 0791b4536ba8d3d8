// ValueSnapshotter: makes value snapshots of the store on request. They take at most 1 % of the simulation thread's
// time, regardless of the number of requests. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/system/clock.h"
#include "base/threads/latest.h"
#include "engine/output/value_snapshot.h"
#include "properties/catalog.h"

namespace limber::engine {

class ValueSnapshotter {
 public:
  static constexpr double kMaxShare = 0.01;  ///< Maximum share of the thread's time.
  static constexpr std::size_t kMaxWrites = 4096;
  static constexpr std::uint64_t kWriteLifetime = 64;  ///< Number of snapshots that contain a note.

  /// `now` returns real time, `cpu_time` the CPU time of the thread, both in seconds. The cost is measured in CPU time,
  /// so that a suspended program incurs no cost.
  explicit ValueSnapshotter(Latest<ValueSnapshot>& out, double (*now)() = &system::clock_seconds,
                            double (*cpu_time)() = &system::thread_seconds)
      : out_(out), now_(now), cpu_time_(cpu_time) {}

  /// Notes that this client has just set the property. Beyond kMaxWrites the oldest notes are dropped.
  void note_write(const Store& store, const CommandOrigin& origin, const PropertyRef& ref, bool clamped);
  /// Makes a snapshot that serves the requests up to number `requests`. `snapshot`: the one that was just published.
  /// Returns false if there is no new request, or if the time budget is spent for now.
  bool make(const Store& store, const std::shared_ptr<const Snapshot>& snapshot, std::uint64_t requests);
  /// Drops everything that refers to the store, because the next call uses another store.
  void reset_store();

 private:
  void fill_computed(const Store& store, ValueSnapshot& snapshot) const;

  Latest<ValueSnapshot>& out_;
  double (*now_)();
  double (*cpu_time_)();
  std::shared_ptr<const TreeSnapshot> tree_;
  std::uint64_t structure_version_ = 0;
  std::uint64_t made_ = 0;
  std::uint64_t served_ = 0;
  double next_ = 0;  // s, earliest time of the next snapshot
  struct PendingWrite {
    ClientWrite write;
    std::uint64_t made_at = 0;
  };
  std::vector<PendingWrite> writes_;
  std::uint64_t write_count_ = 0;
};

}  // namespace limber::engine
