// RunInputs: what a scene that is run beside the show may read of it, as plain data that travels between threads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "params/table.h"

namespace limber {

class Sources;

/// A parameter of the scene as the show has it.
struct LiveParam {
  Row row;
  std::array<double, 4> values{};
};

struct RunInputs {
  std::uint64_t tick = 0;
  double time = 0;
  std::string state;  ///< As Scene::state() gives it.
  std::vector<LiveParam> params;
  std::shared_ptr<const Sources> sources;  ///< What to read instead of the disk; null: the disk.
};

}  // namespace limber
