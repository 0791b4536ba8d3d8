// The table of units.
#include "params/units.h"

#include <algorithm>
#include <array>

namespace limber {

namespace {
constexpr std::array kUnits = {
    Unit{"m", "metre"},
    Unit{"kg", "kilogram"},
    Unit{"s", "second"},
    Unit{"ms", "millisecond of simulated time"},
    Unit{"µs", "microsecond of the processor"},
    Unit{"rad", "radian"},
    Unit{"deg", "degree"},
    Unit{"Hz", "per second"},
    Unit{"m/s", "metre per second"},
    Unit{"m/s²", "metre per second squared"},
    Unit{"rad/s", "radian per second"},
    Unit{"m/s | rad/s", "metre per second along, radian per second about the axis"},
    Unit{"m | rad", "metre along, radian about the axis"},
    Unit{"N", "newton"},
    Unit{"N·m", "newton metre"},
    Unit{"N | N·m", "newton along, newton metre about the axis"},
    Unit{"N·s", "newton second"},
    Unit{"N/m", "newton per metre"},
    Unit{"N·s/m", "newton second per metre"},
    Unit{"m/N", "metre per newton"},
    Unit{"rad/(N·m)", "radian per newton metre"},
    Unit{"N·m/rad", "newton metre per radian"},
    Unit{"N·m·s/rad", "newton metre second per radian"},
    Unit{"N·s/m | N·m·s/rad", "newton second per metre along, newton metre second per radian about the axis"},
    Unit{"1/s", "fraction lost per second"},
    Unit{"1/s²", "per second squared"},
    Unit{"kg·m²", "kilogram metre squared"},
    Unit{"× real time", "simulated seconds per real second"},
    Unit{"hsb", "hue, saturation, brightness"},
};
}  // namespace

std::span<const Unit> units() { return kUnits; }

bool known_unit(std::string_view symbol) {
  return symbol.empty() || std::any_of(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.symbol == symbol; });
}

}  // namespace limber
