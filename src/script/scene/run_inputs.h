// RunInputs: the data of the live scene that a detached run may read; plain data that can be passed between threads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "properties/property_table.h"

namespace limber::script {

class Sources;

/// A parameter of the live scene.
struct LiveParam {
  Property property;
  std::array<double, 4> values{};
};

struct RunInputs {
  std::uint64_t tick = 0;
  double time = 0;
  std::string state;  ///< Result of Vm::state_text().
  std::vector<LiveParam> params;
  std::shared_ptr<const Sources> sources;  ///< Files to use instead of the disk; null: the disk.
};

}  // namespace limber::script
