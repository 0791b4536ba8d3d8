// English plurals.
#include "base/plural.h"

namespace limber {

std::string plural(std::uint64_t count, std::string_view one, std::string_view many) {
  if (count == 1) return std::string(one);
  return many.empty() ? std::string(one) + 's' : std::string(many);
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  return std::to_string(count) + ' ' + plural(count, one, many);
}

}  // namespace limber
