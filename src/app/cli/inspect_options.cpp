// Options of `inspect`, with their help.
#include "app/cli/inspect_options.h"

#include <CLI/CLI.hpp>

namespace limber::app {

void add_inspect(CLI::App& app, InspectCommand& options) {
  CLI::App* inspect = app.add_subcommand(
      "inspect", "Check a URDF or MJCF file: links, joints, and every problem with its line and fix.");
  inspect->footer(
      "  limber inspect urdf/arm6.urdf                a table of the arm, and its problems\n"
      "  limber inspect robot.urdf --json             the same for programs\n"
      "  limber inspect robot.urdf --screenshot robot.png  also an image of it\n"
      "  limber robot.urdf                            look at it in a window, and move it");
  inspect->add_option("file", options.file, "The robot: URDF, or MJCF (.xml), or a folder with one.")
      ->type_name("FILE.urdf|FILE.xml|DIR")
      ->required();
  inspect->add_flag("--json", options.json, "Print JSON.");
  inspect->add_option("--package-path", options.package_paths, "Folder for package:// paths; may be repeated.")
      ->type_name("DIR")
      ->allow_extra_args(false);
  inspect
      ->add_option("--root", options.root, "MJCF: the top-level body to show, or world; default: the first that moves.")
      ->type_name("BODY");
  inspect
      ->add_option("--screenshot", options.screenshot,
                   "Also render an image of the robot in its start pose; needs no display.")
      ->type_name("FILE.png");
  inspect->add_option("--size", options.size, "Size of the image; default 1280x720.")->type_name("WxH");
}

}  // namespace limber::app
