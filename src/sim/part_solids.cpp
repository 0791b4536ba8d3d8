// PartSolids: gathering, and those who look.
#include "sim/part_solids.h"

#include "sim/part.h"

namespace limber {

void PartSolids::add(const Part& part) {
  const std::size_t place = part.load_place();
  const std::size_t slot = part.id().slot;
  if (place >= list_.size()) list_.resize(place + 1);
  if (slot >= places_.size()) places_.resize(slot + 1);
  const Vec3 center = part.geometry()->frame.position;
  const Vec3 inertia = part.geometry()->unit_inertia;
  list_[place] = {{center.x, center.y, center.z}, {inertia.x, inertia.y, inertia.z}};
  places_[slot] = static_cast<std::int32_t>(place);
  for (View* const view : views_) *view = {list_.data(), places_.data()};
}

void PartSolids::show_view(View& copy) {
  copy = {list_.data(), places_.data()};
  views_.push_back(&copy);
}

void PartSolids::hide_view(View& copy) { std::erase(views_, &copy); }

}  // namespace limber
