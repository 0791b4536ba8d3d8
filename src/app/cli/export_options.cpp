// Declares the options of `limber export` with CLI11.
#include "app/cli/export_options.h"

#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/text.h"

namespace limber::app {

namespace {

// a number within a range
CLI::Validator number_between(double min, double max) {
  return CLI::Validator(
      [min, max](std::string& text) {
        const std::optional<double> number = parse_number(text);
        return number && *number >= min && *number <= max
                   ? std::string()
                   : fmt::format("'{}' must be a number from {} to {}", text, number_text(min), number_text(max));
      },
      "", "number");
}

}  // namespace

void add_export(CLI::App& app, ExportCommand& command) {
  CLI::App* subcommand = app.add_subcommand("export", "Export a take as motion for other programs: CSV, BVH, glTF.");
  subcommand->footer(
      "Replays the take at full speed and samples it at the frame rate, interpolating between ticks.\n"
      "  csv   a table, one line per frame: position and rotation of each part, value of each joint\n"
      "  bvh   one skeleton per body; Y up, meters; -o NAME.bvh writes one body, else a folder\n"
      "  gltf  bodies with their meshes and one animation; Y up, meters; .glb, or .gltf with a .bin file\n"
      "  limber export evening.take --format gltf                    write evening.glb\n"
      "  limber export evening.take -o arm1.bvh --body arm1 --rate 30\n"
      "  limber export evening.take -o arms.csv --body 'arm*' --from 60 --to 90\n"
      "The formats are described in docs/howto/export.md.");
  subcommand->add_option("take", command.take, "The take.")->type_name("TAKE")->required();
  subcommand->add_option("--format", command.format, "Format; default: by the extension of -o.")
      ->type_name("csv|bvh|gltf")
      ->check(CLI::IsMember({"csv", "bvh", "gltf"}));
  subcommand->add_option("-o,--output", command.output, "Output file; default: next to the take, with the same name.")
      ->type_name("FILE");
  subcommand->add_option("--rate", command.rate, "Frames per simulated second; default 60.")
      ->type_name("N")
      ->check(number_between(0.01, 10000));
  subcommand->add_option("--body", command.bodies, "Export only bodies of this name or pattern; may be repeated.")
      ->type_name("PATTERN")
      ->allow_extra_args(false);
  subcommand->add_option("--with", command.extras, "CSV: add velocities, torques of motors, contacts; a list.")
      ->type_name("velocities|torques|contacts")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"velocities", "torques", "contacts"}));
  subcommand->add_option("--from", command.from, "Start time in simulated seconds of the take.")
      ->type_name("S")
      ->check(number_between(0, 1e9));
  subcommand->add_option("--to", command.to, "End time.")->type_name("S")->check(number_between(0, 1e9));
  subcommand->add_flag("--overwrite", command.overwrite, "Overwrite an existing file.");
}

}  // namespace limber::app
