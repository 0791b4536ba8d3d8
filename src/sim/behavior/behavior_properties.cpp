// The common properties of behaviors and groups, and their callbacks.
#include "sim/behavior/behavior_properties.h"

#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sim/behavior/behavior_list.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

Result<void> check_can_move(const BehaviorGroup& group) { return group.world().behaviors().check_can_move(); }

Result<void> check_can_move(const Behavior& behavior) {
  if (behavior.group() == nullptr) return behavior.world().behaviors().check_can_move();
  return Error{fmt::format("a group's member has no place of its own; set /physics/group/{}/place", behavior.name())};
}

// The callbacks of a Behavior or a BehaviorGroup.
template <class T>
struct Callbacks {
  static const T& of(const void* object) { return *static_cast<const T*>(object); }

  static void read_time(const void* object, double* out) { out[0] = of(object).step_microseconds(); }
  static Result<void> remove(void* object, std::span<const double>) {
    of(object).world().behaviors().remove(*static_cast<T*>(object));
    return {};
  }
  static void read_place(const void* object, double* out) {
    out[0] = static_cast<double>(of(object).world().behaviors().order().place(of(object)));
  }
  static void write_place(void* object, const double* in) {
    of(object).world().behaviors().order().move(*static_cast<T*>(object), static_cast<std::size_t>(in[0]));
  }
  static Result<void> validate_place(const void* object, const double*) { return check_can_move(of(object)); }
};

template <class T>
std::vector<Property> common_properties(Property active, Property time, Property remove, Property place) {
  time.read = &Callbacks<T>::read_time;
  remove.invoke = &Callbacks<T>::remove;
  place.read = &Callbacks<T>::read_place;
  place.write = &Callbacks<T>::write_place;
  place.validate = &Callbacks<T>::validate_place;
  return {std::move(active), readout(std::move(time)), std::move(remove), state(std::move(place))};
}

Property time_property(std::string doc) { return number("time", "µs", 0, 0, kUnbounded, std::move(doc)); }
Property place_property(std::string doc) { return integer("place", 1, 1, 1e6, std::move(doc)); }

}  // namespace

std::vector<Property> common_behavior_properties() {
  Property active = boolean("active", true, "Whether it acts; setting it also clears an error.");
  active.on_write = [](void* object, const Property&) { static_cast<Behavior*>(object)->clear_fault(); };
  return common_properties<Behavior>(std::move(active), time_property("Time that it took in the last tick."),
                                     action("remove", 0, 0, "Removes the behavior."),
                                     place_property("Position in the step order of its body's behaviors, from 1."));
}

std::vector<Property> common_group_properties() {
  Property active = boolean("active", true, "Whether its members act; setting it sets theirs.");
  active.on_write = &BehaviorGroup::set_on_members;
  return common_properties<BehaviorGroup>(
      std::move(active), time_property("Time that all its members took in the last tick."),
      action("remove", 0, 0, "Removes the group and all its members."),
      place_property("Position in the step order of all names of behaviors, from 1."));
}

}  // namespace limber::sim
