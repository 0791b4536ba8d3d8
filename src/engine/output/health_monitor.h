// HealthMonitor: collects the counters of other modules in EngineLink::health once a pass. [sim]
#pragma once

#include <cstdint>

#include "base/log/log.h"
#include "base/log/output.h"
#include "engine/show_state.h"

namespace limber::engine {

class HealthMonitor {
 public:
  explicit HealthMonitor(ShowState& show) : show_(show) {}

  /// `not_owned`: another program owns the recovery file of the scene.
  void update(bool not_owned);

 private:
  ShowState& show_;
  std::uint64_t health_events_ = 0;  // of this session, already counted
  std::uint64_t passes_ = 0;
  // program-wide counters at the construction of the engine
  const std::uint64_t lines_lost_before_ = lost_output_lines();
  const std::uint64_t log_suppressed_before_ = log_suppressed();
  const std::uint64_t writes_failed_before_ = failed_writes();
};

}  // namespace limber::engine
