// MassTable: adds parts and updates the registered views.
#include "sim/neighbors/mass_table.h"

#include "sim/world/part.h"

namespace limber::sim {

void MassTable::add(const Part& part) {
  const std::size_t index = part.accumulator_index();
  const std::size_t slot = part.id().slot;
  if (index >= entries_.size()) entries_.resize(index + 1);
  if (slot >= index_of_slot_.size()) index_of_slot_.resize(slot + 1);
  const Vec3 center = part.geometry()->frame.position;
  const Vec3 inertia = part.geometry()->unit_inertia;
  entries_[index] = {{center.x, center.y, center.z}, {inertia.x, inertia.y, inertia.z}};
  index_of_slot_[slot] = static_cast<std::int32_t>(index);
  for (View* const view : views_) *view = {entries_.data(), index_of_slot_.data()};
}

void MassTable::register_view(View& copy) {
  copy = {entries_.data(), index_of_slot_.data()};
  views_.push_back(&copy);
}

void MassTable::unregister_view(View& copy) { std::erase(views_, &copy); }

}  // namespace limber::sim
