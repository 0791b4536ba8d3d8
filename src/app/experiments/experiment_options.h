// Options of `limber sweep` and `limber evolve`, as typed, and the functions that run them. A function returns the exit
// code. [main]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace limber::app {

/// Options of both commands.
struct ExperimentOptions {
  std::string scene;
  std::vector<std::string> params;  ///< NAME=VALUES; empty: all parameters of the scene that have a range.
  std::string seeds = "1";
  double duration = 10;  ///< Simulated seconds of each evaluation.
  std::string out;
  int jobs = 0;              ///< Number of processes; 0: one per core.
  std::string mpi = "auto";  ///< auto, openmpi, mpich, off.
  double time_limit = 300;   ///< Real time of an evaluation, s.
  bool resume = false;
  bool overwrite = false;
};

struct SweepCommand {
  ExperimentOptions common;  ///< `out`: a table; empty: the standard output.
  std::string design;        ///< grid, random, latin, sobol; empty: grid, or sobol if `samples` is given.
  std::uint64_t samples = 0;
  std::uint64_t design_seed = 1;
};
/// `limber sweep`: evaluates a scene at the points of a design, and writes a table of results. Returns 1 if the scene
/// has an error, if all evaluations failed, or if it was stopped; 3 if the table can't be written.
int sweep_command(const SweepCommand& command);

struct EvolveCommand {
  ExperimentOptions common;           ///< `out`: a folder.
  std::vector<std::string> maximize;  ///< Names of results.
  std::vector<std::string> minimize;
  std::string algorithm;                 ///< Word for --algorithm; empty: by objectives and descriptors.
  std::vector<std::string> descriptors;  ///< Names of results with a range.
  int generations = 100;
  int population = 0;  ///< Individuals per generation; 0: the algorithm's default.
  std::uint64_t search_seed = 1;
  std::string play;  ///< Folder of a search to play; empty: search. `common.scene` is then the elite.
};
/// `limber evolve`: searches for the parameters with the largest or smallest result. Returns as sweep_command().
int evolve_command(const EvolveCommand& command);

}  // namespace limber::app
