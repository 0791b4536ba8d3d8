// What presets of many parts cost the tick.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// 1000 arms of 17 parts, each with a joint and a motor: a preset of every property stored and recalled, first and
/// again, and a morph that moves six rows of every part.
nlohmann::ordered_json bench_preset(const BenchOptions& options);

}  // namespace limber
