// WorldCheckpoint: serializes Bullet's memory and the store's values as raw pages, and the fields of each object.
#include "sim/state/world_checkpoint.h"

#include "sim/world/world.h"

namespace limber::sim {

void WorldCheckpoint::capture(World& world, PageStore& pages, const WorldCheckpoint* previous, Archive& scratch) {
  const auto capture_pages = [&](PageStore::PageList& pages_of, std::span<const std::byte> memory,
                                 const PageStore::PageList* shared) {
    pages_of.clear();
    pages.append(pages_of, memory, shared);
  };
  const Store& store = world.store();
  world.bullet_memory().arena().capture(pages, previous == nullptr ? nullptr : &previous->bullet_, bullet_);
  capture_pages(persistent_, std::as_bytes(store.persistent_values()),
                previous == nullptr ? nullptr : &previous->persistent_);
  capture_pages(transient_, std::as_bytes(store.transient_values()),
                previous == nullptr ? nullptr : &previous->transient_);
  scratch.begin_saving();
  world.serialize(scratch);
  objects_size_ = scratch.bytes().size();
  capture_pages(objects_, scratch.bytes(), previous == nullptr ? nullptr : &previous->objects_);
}

void WorldCheckpoint::restore(World& world, const PageStore& pages, Archive& scratch) const {
  Store& store = world.store();
  world.bullet_memory().arena().restore(pages, bullet_);
  pages.restore(persistent_, 0, std::as_writable_bytes(store.restore_persistent_values()));
  pages.restore(transient_, 0, std::as_writable_bytes(store.restore_transient_values()));
  scratch.bytes().resize(objects_size_);
  pages.restore(objects_, 0, scratch.bytes());
  scratch.begin_loading();
  world.serialize(scratch);
}

void WorldCheckpoint::release(PageStore& pages) {
  for (PageStore::PageList* list : {&bullet_, &persistent_, &transient_, &objects_}) pages.release(*list);
}

}  // namespace limber::sim
