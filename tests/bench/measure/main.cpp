// limber_measure: measures the speed of this build, module by module.
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/exit_code.h"
#include "bench/measure/measures.h"

int main(int argc, char** argv) {
  using namespace limber;
  std::string list;
  for (const Measure& measure : measures()) list += fmt::format("\n  {:<18}{}", measure.name, measure.doc);
  CLI::App app{"Measure the speed of this build.\n\nMeasurements:" + list};
  MeasureOptions options;
  app.add_option("name", options.names, "Measurements to run; default: all.");
  app.add_flag("--compare-raw", options.compare_raw, "Compare arms with a plain Bullet loop.");
  app.add_flag("--json", options.json, "Print JSON.");
  app.add_option("--gl", options.gl, "Kind of OpenGL, as in `limber --gl`.");
  app.add_option("--ticks", options.ticks, "Number of timed ticks; default: depends on the measurement.");
  CLI11_PARSE(app, argc, argv);
  return app::finish_command(run_measures(options));
}
