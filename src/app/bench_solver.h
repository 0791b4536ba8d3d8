// The bench of the solvers: the same machines in stock Bullet and with the direct solver, step by step in turn.
#pragma once

#include <nlohmann/json.hpp>

namespace limber {

/// `steps`: of each scene; 0: six simulated seconds. Figures per scene: what joints, servos and limits miss, time a
/// step, and who solved the islands.
nlohmann::ordered_json bench_solver(int steps);

/// 300 creatures of six parts in one clump, and 2000 boxes that pile up on a floor: stock Bullet's defaults beside our
/// world. `steps`; 0: so many that they meet (300), or come to rest (400), the second half of which is timed.
nlohmann::ordered_json bench_swarm(int steps);
nlohmann::ordered_json bench_pile(int steps);

}  // namespace limber
