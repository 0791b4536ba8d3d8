// Benchmark of presets of many parts.
#pragma once

#include <nlohmann/json.hpp>

#include "app/commands/bench.h"

namespace limber {

/// 1000 arms of 17 parts, each with a joint and a motor: storing and recalling a preset of all properties, the first
/// time and repeatedly, and a morph that changes six properties of every part.
nlohmann::ordered_json bench_preset(const BenchOptions& options);

}  // namespace limber
