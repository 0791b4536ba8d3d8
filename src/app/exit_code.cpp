// How a command says that it failed.
#include "app/exit_code.h"

#include <cstdio>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

int fail(int code, std::string_view text) {
  fmt::print(stderr, "limber: {}\n", printable(text));
  return code;
}

}  // namespace limber
