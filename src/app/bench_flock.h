// Group behaviours of the bench: many bodies that follow their neighbours.
#pragma once

#include "app/bench.h"

namespace limber {

/// So many bodies of one part, about 30 neighbours each; cohesion and alignment: the behaviours' share of a tick, and
/// what surrounds it.
nlohmann::ordered_json bench_flock(int bodies, const BenchOptions& options);

}  // namespace limber
