// The list of units.
#include "properties/units.h"

#include <algorithm>
#include <array>

namespace limber {

namespace {
constexpr std::array kUnits = {
    Unit{"m", "meter"},
    Unit{"kg", "kilogram"},
    Unit{"s", "second"},
    Unit{"ms", "millisecond of simulated time"},
    Unit{"µs", "microsecond of the processor"},
    Unit{"rad", "radian"},
    Unit{"deg", "degree"},
    Unit{"deg/s", "degree per second"},
    Unit{"deg/s²", "degree per second squared"},
    Unit{"Hz", "per second"},
    Unit{"m/s", "meter per second"},
    Unit{"m/s²", "meter per second squared"},
    Unit{"m/s³", "meter per second cubed"},
    Unit{"rad/s", "radian per second"},
    Unit{"m/s | rad/s", "meter per second along, radian per second about the axis"},
    Unit{"m | rad", "meter along, radian about the axis"},
    Unit{"N", "newton"},
    Unit{"N·m", "newton meter"},
    Unit{"N | N·m", "newton along, newton meter about the axis"},
    Unit{"N·s", "newton second"},
    Unit{"N/m", "newton per meter"},
    Unit{"N·s/m", "newton second per meter"},
    Unit{"m/N", "meter per newton"},
    Unit{"rad/(N·m)", "radian per newton meter"},
    Unit{"N·m/rad", "newton meter per radian"},
    Unit{"N·m·s/rad", "newton meter second per radian"},
    Unit{"N·s/m | N·m·s/rad", "newton second per meter along, newton meter second per radian about the axis"},
    Unit{"1/s", "fraction lost per second"},
    Unit{"1/s²", "per second squared"},
    Unit{"kg·m²", "kilogram meter squared"},
    Unit{"kg | kg·m²", "kilogram along, kilogram meter squared about the axis"},
    Unit{"kg·m/s", "kilogram meter per second"},
    Unit{"kg·m²/s", "kilogram meter squared per second"},
    Unit{"J", "joule"},
    Unit{"beats", "beats of musical time"},
    Unit{"beats/min", "beats per minute"},
    Unit{"× real time", "simulated seconds per real second"},
    Unit{"hsb", "hue, saturation, brightness"},
};
}  // namespace

std::span<const Unit> units() { return kUnits; }

bool known_unit(std::string_view symbol) {
  return symbol.empty() || std::any_of(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.symbol == symbol; });
}

}  // namespace limber
