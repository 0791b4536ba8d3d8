// Benchmark of the solvers: the same mechanisms in stock Bullet and with the direct solver, alternating step by step.
#pragma once

#include <nlohmann/json.hpp>

namespace limber {

/// `steps`: per scene; 0: six simulated seconds. Returns per scene the errors of joints, servos and limits, the time
/// per step, and which solver solved the islands.
nlohmann::ordered_json bench_solver(int steps);

/// 300 creatures of six parts in a clump, and 2000 boxes that pile up on a floor: stock Bullet with its defaults
/// against Limber's world. `steps`; 0: as many as the creatures need to collide (300) or the boxes to come to rest
/// (400); the second half is timed.
nlohmann::ordered_json bench_swarm(int steps);
nlohmann::ordered_json bench_pile(int steps);

}  // namespace limber
