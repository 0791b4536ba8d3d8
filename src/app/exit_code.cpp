// How a command reports that it failed, and how the program ends.
#include "app/exit_code.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/log.h"
#include "base/output.h"
#include "base/text.h"

namespace limber {

int fail(int code, std::string_view text) {
  write_message(MessageLevel::error, printable(text));
  return code;
}

int finish_command(int code) {
  if (const std::uint64_t count = log_left_out(); count > 0)
    print_notice("{} repeated line{} left out above", count, count == 1 ? " is" : "s are");
  const int error = result_error();
  // a reader that needs no more, and a signal, end a command quietly
  if (error == ETIMEDOUT) {
    code = fail(kMachine,
                "standard output was not read until the end: the result is missing; read it, or write it to a file");
  } else if (error != 0 && error != EPIPE && error != EINTR) {
    code = fail(kMachine,
                fmt::format("standard output can't be written: {}; the result is missing or cut off. Make room on the "
                            "disk, or write it elsewhere",
                            std::generic_category().message(error)));
  }
  finish_output();
  return code;
}

void end_program(int code) { std::_Exit(finish_command(code)); }

}  // namespace limber
