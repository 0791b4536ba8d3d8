// How soon a saved scene plays, and what that does to the ticks around it.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench.h"

namespace limber {

/// A scene of sixteen arms and one of a thousand, saved again and again while they play: the time from the save to the
/// first tick of the new code, and the longest tick near it beside the median one.
nlohmann::ordered_json bench_reload(const BenchOptions& options);

}  // namespace limber
