// Declares the options of `limber sweep`, `limber evolve` and `limber breed` with CLI11.
#include "app/cli/experiment_options.h"

#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/cli/play_options.h"
#include "app/option_checks.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr const char* kSweepExamples =
    "The scene declares its numbers: result(\"distance\", function() return body.position.x end).\n"
    "  limber sweep my.lua --param rate=0.1:1:0.1 --param depth=0.2,0.4 --seeds 1:5 --out rates.csv\n"
    "  limber sweep my.lua --param rate=0.1:1/10    ten values from 0.1 to 1; the table goes to stdout\n"
    "  limber sweep my.lua --samples 200 --out all.csv  200 points within the ranges of all parameters\n"
    "  limber sweep my.lua --samples 200 --out all.csv --resume  continue after Ctrl+C or a crash\n"
    "  mpirun -n 64 limber sweep my.lua --samples 9999 --out all.csv  64 processes, on several machines\n"
    "A row has the values, the seed, the results, the state hash and the command that plays it. Neither the\n"
    "order nor the numbers depend on --jobs. An evaluation that fails has the reason in the column error.\n"
    "Exit codes: 1 the scene has an error, all evaluations failed, or Ctrl+C; 3 the table can't be written.";

constexpr const char* kEvolveExamples =
    "The scene declares parameters with ranges, and results; a result with a range is a descriptor.\n"
    "  limber evolve my.lua --maximize distance     CMA-ES: the best values, in the folder my_evolve\n"
    "  limber evolve my.lua --maximize distance --descriptor height --descriptor effort\n"
    "                                               MAP-Elites: the best for each cell of height and effort\n"
    "  limber evolve my.lua --maximize distance --minimize effort\n"
    "                                               NSGA-II: the best compromises of both\n"
    "  limber evolve my.lua --maximize distance --resume  continue after Ctrl+C or a crash\n"
    "  mpirun -n 64 limber evolve my.lua --maximize distance  64 processes, on several machines\n"
    "  limber evolve --play my_evolve               play the best; others are presets to recall and morph\n"
    "  limber evolve --play my_evolve cell_3_7 --fullscreen  another elite, with options of play\n"
    "The file elites.csv in the folder has a row for each elite, with the command that plays it.\n"
    "The result doesn't depend on --jobs and interruptions.\n"
    "Exit codes: 1 the scene has an error, nothing was found, or Ctrl+C; 3 the folder can't be written.";

constexpr const char* kBreedExamples =
    "Nine variations play side by side. Click those you like, then press Mutate or Cross for the next nine.\n"
    "Keep stores the liked ones as presets of the scene, which limber my.lua recalls.\n"
    "  limber breed my.lua                          variations of all parameters that have a range\n"
    "  limber breed my.lua --param rate=0.5:1.5 --param gait=walk,trot  these parameters only\n"
    "  limber breed my.lua --from calm,wild         begin with these presets of the scene\n"
    "  limber breed my.lua --presets my_evolve/elites.presets.json --from best_12\n"
    "                                               begin with the result of a search\n"
    "Keys: 1 to 9 like, M mutate, C cross, R random, K keep, Ctrl+Z undo, Ctrl+Y redo, Space pause, Home start\n"
    "again, F follow, F11 full screen. Drag and wheel move all cameras.\n"
    "Exit codes: 1 the scene has an error; 3 there is no display.";

CLI::Validator number_above(double limit, double max, const char* what) {
  return CLI::Validator(
      [limit, max, what](std::string& text) {
        const std::optional<double> number = parse_number(text);
        return number && *number > limit && *number <= max
                   ? std::string()
                   : fmt::format("'{}' must be {} above {} and at most {}", text, what, number_text(limit),
                                 number_text(max));
      },
      "", "number");
}

CLI::Validator count() {
  return CLI::Validator([](std::string& text) { return whole_number_fault(text); }, "", "count");
}

void add_params(CLI::App& app, ExperimentOptions& o, const char* text) {
  app.add_option("--param", o.params, text)->type_name("NAME=VALUES")->allow_extra_args(false);
}

void add_common(CLI::App& app, ExperimentOptions& o, const char* params) {
  add_params(app, o, params);
  app.add_option("--seeds", o.seeds, "Seeds of each point: FIRST:LAST, or a list such as 1,2,7; default 1.")
      ->type_name("SEEDS");
  app.add_option("--duration", o.duration, "Simulated seconds of an evaluation; default 10.")
      ->type_name("S")
      ->check(number_above(0, 1e9, "a time in seconds"));
  app.add_option("--jobs", o.jobs, "Number of processes; default: one per core. The result is the same for any.")
      ->type_name("N")
      ->check(between(1, 1024));
  app.add_option("--mpi", o.mpi,
                 "The MPI whose mpirun or srun started this: auto (default), openmpi, mpich; off: run separately.")
      ->type_name("auto|openmpi|mpich|off")
      ->check(CLI::IsMember({"auto", "openmpi", "mpich", "off"}));
  app.add_option("--time-limit", o.time_limit,
                 "Seconds of real time after which an evaluation is stopped; tried three times; default 300.")
      ->type_name("S")
      ->check(number_above(0, 1e6, "a time in seconds"));
  CLI::Option* resume = app.add_flag("--resume", o.resume, "Continue what an interrupted run has left.");
  app.add_flag("--overwrite", o.overwrite, "Replace existing output.")->excludes(resume);
}

}  // namespace

void add_sweep(CLI::App& app, SweepCommand& command) {
  CLI::App* sweep = app.add_subcommand("sweep", "Run a scene with many values of its parameters; a table of results.");
  sweep->footer(kSweepExamples);
  sweep->add_option("scene", command.common.scene, "The scene.")->type_name("SCENE.lua")->required();
  add_common(*sweep, command.common,
             "Values of a parameter: MIN:MAX:STEP, MIN:MAX/N, MIN:MAX, or a list; may be repeated. Default: the "
             "ranges of all parameters.");
  sweep
      ->add_option("--design", command.design,
                   "The points: grid (all combinations), random, latin (a Latin hypercube), sobol; default: grid, or "
                   "sobol with --samples.")
      ->type_name("grid|random|latin|sobol")
      ->check(CLI::IsMember({"grid", "random", "latin", "sobol"}));
  sweep->add_option("--samples", command.samples, "Number of points of random, latin and sobol.")
      ->type_name("N")
      ->check(count());
  sweep->add_option("--design-seed", command.design_seed, "Seed of the points of random and latin; default 1.")
      ->type_name("N")
      ->check(count());
  sweep
      ->add_option("--out", command.common.out,
                   "The table: CSV, or JSON Lines if the name ends with .jsonl; default: CSV to stdout.")
      ->type_name("FILE");
}

void add_evolve(CLI::App& app, EvolveCommand& command) {
  CLI::App* evolve = app.add_subcommand("evolve", "Search for the parameters of a scene with the best result.");
  evolve->footer(kEvolveExamples);
  evolve
      ->add_option("scene", command.common.scene,
                   "The scene; with --play the number or name of an elite, by default the best.")
      ->type_name("SCENE.lua|ELITE");
  evolve
      ->add_option("--play", command.play,
                   "Play an elite of the search in this folder, with the others as presets; options of play may "
                   "follow.")
      ->type_name("DIR");
  add_common(*evolve, command.common,
             "Range of a parameter, MIN:MAX, or a list of values; may be repeated. Default: the ranges of all "
             "parameters.");
  evolve
      ->add_option("--maximize", command.maximize,
                   "Search for the largest value of this result; may be repeated, also with --minimize: then the "
                   "result is the Pareto front.")
      ->type_name("RESULT")
      ->allow_extra_args(false);
  evolve->add_option("--minimize", command.minimize, "Search for the smallest value of this result; may be repeated.")
      ->type_name("RESULT")
      ->allow_extra_args(false);
  evolve
      ->add_option("--algorithm", command.algorithm,
                   "cma-es (one objective), map-elites (with --descriptor), nsga2 (any number of objectives); default: "
                   "the first of these that fits. Of pagmo, if its module is installed: gaco, pso (one), maco, nspso "
                   "(several).")
      ->type_name("cma-es|map-elites|nsga2|gaco|pso|maco|nspso")
      ->check(CLI::IsMember({"cma-es", "map-elites", "nsga2", "gaco", "pso", "maco", "nspso"}));
  evolve
      ->add_option("--descriptor", command.descriptors,
                   "A result with a range: keep the best for each of its cells (MAP-Elites); may be repeated.")
      ->type_name("RESULT")
      ->allow_extra_args(false);
  evolve->add_option("--generations", command.generations, "Number of generations; default 100.")
      ->type_name("N")
      ->check(between(1, 1000000));
  evolve
      ->add_option(
          "--population", command.population,
          "Points per generation; default: 4 + 3 ln(number of parameters), of map-elites 100, of the others 40.")
      ->type_name("N")
      ->check(between(4, 100000));
  evolve->add_option("--search-seed", command.search_seed, "Seed of the search; default 1.")
      ->type_name("N")
      ->check(count());
  evolve->add_option("--out", command.common.out, "Folder of the results; default: SCENE_evolve.")->type_name("DIR");
}

void add_breed(CLI::App& app, BreedCommand& command) {
  CLI::App* breed = app.add_subcommand("breed", "Select variations of a scene by eye, nine side by side.");
  breed->footer(kBreedExamples);
  breed->add_option("scene", command.common.scene, "The scene.")->type_name("SCENE.lua")->required();
  add_params(*breed, command.common,
             "Range of a parameter, MIN:MAX, or a list of values; may be repeated. Default: the ranges of all "
             "parameters.");
  breed->add_option("--seed", command.common.seeds, "Seed of all variations; default 1.")
      ->type_name("N")
      ->check(count());
  breed->add_option("--search-seed", command.search_seed, "Seed of mutations and crossings; default 1.")
      ->type_name("N")
      ->check(count());
  breed->add_option("--from", command.from, "Presets to begin with, separated by commas; default: the scene's values.")
      ->type_name("NAMES")
      ->delimiter(',');
  breed->add_option("--presets", command.presets, "File of the presets; default: that of the scene.")
      ->type_name("FILE.json");
  add_window_options(*breed, command.display);
}

}  // namespace limber::app
