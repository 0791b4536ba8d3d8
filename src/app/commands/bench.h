// `limber bench`: measures how many arms this machine plays in real time.
#pragma once

namespace limber {

struct BenchOptions {
  bool json = false;
  int ticks = 0;  ///< Timed ticks for each number of arms; 0: 60.
};

/// Plays more and more arms with each solver, with one thread and with one per core, until they are slower than real
/// time. Prints the results. Returns the exit code. [main]
int bench_command(const BenchOptions& options);

}  // namespace limber
