// The scene of the tests of sweep and evolve, and the rows of their tables.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "app/program.h"

namespace limber::app::test {

/// A ball without gravity that is pushed at the start. After t seconds it is at push · t / mass.
inline constexpr const char* kPush = R"(
params {
  { "push", 1, min = 0, max = 4 },
  { "mass", 1, min = 0.5, max = 2, rerun = true },
  { "way", "forth", choices = { "forth", "back" } },
}
sim.gravity = vec3()
local ball = sim:add_body("ball")
local part = ball:add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = params.mass })
sim:on_start(function()
  part:apply_impulse(vec3(params.way == "forth" and params.push or -params.push, 0, 0))
end)
sim:record { rate = 10, { "x", function() return part.position.x end } }
result("distance", function() return part.position.x end, { min = -10, max = 10, cells = 20 })
result("noise", function() return rng:uniform() end)
)";

/// Cells of a line of CSV.
using Row = std::vector<std::string>;

inline std::vector<Row> rows(const std::string& csv) {
  std::vector<Row> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    Row& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

}  // namespace limber::app::test
