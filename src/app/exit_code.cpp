// Reports errors of commands and ends the program.
#include "app/exit_code.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/text.h"

namespace limber::app {

int fail(int code, std::string_view text) {
  write_message(MessageLevel::error, printable(text));
  return code;
}

int finish_command(int code) {
  if (const std::uint64_t count = log_suppressed(); count > 0)
    print_notice("{} suppressed above", counted(count, "repeated line is", "repeated lines are"));
  const int error = result_error();
  // a closed pipe or a signal ends a command quietly
  if (error == ETIMEDOUT) {
    code = fail(kMachineError,
                "standard output was not read to the end: the result is incomplete. Read it, or write it to a file");
  } else if (error != 0 && error != EPIPE && error != EINTR) {
    code = fail(
        kMachineError,
        fmt::format(
            "standard output can't be written: {}; the result is incomplete. Free disk space, or write it elsewhere",
            std::generic_category().message(error)));
  }
  finish_output();
  return code;
}

void end_program(int code) { std::_Exit(finish_command(code)); }

}  // namespace limber::app
