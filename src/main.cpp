// The program.
#include "app/cli/options.h"
#include "base/system/standard_output.h"

int main(int argc, char** argv) {
  limber::system::prepare_standard_descriptors();
  return limber::app::run_command_line(argc, argv);
}
