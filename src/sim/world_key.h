// WorldKey: a world between two ticks, with all that its next ticks depend on, to be brought back to the bit as long as
// nothing has come or gone. [sim]
#pragma once

#include <cstdint>

#include "base/key_bytes.h"
#include "base/page_store.h"

namespace limber {

class Behavior;
class BehaviorList;
class Body;
class Store;
class World;

class WorldKey {
 public:
  /// Takes the world as it is, in pages that are shared with `before`, an older key of it, or null. `scratch` is used
  /// again and again.
  void take(World& world, PageStore& pages, const WorldKey* before, KeyBytes& scratch);
  /// The world is as it was taken. Its structure must be: Store::structure_version() is the same, and shapes have as
  /// many children. What is only counted (turns, versions, calls) goes on.
  void bring_back(World& world, const PageStore& pages, KeyBytes& scratch) const;
  /// Gives its pages back.
  void release(PageStore& pages);

 private:
  static void pass(KeyBytes& key, World& world);
  static void pass(KeyBytes& key, Store& store);
  static void pass(KeyBytes& key, Body& body);
  static void pass(KeyBytes& key, Behavior& behavior);
  static void pass(KeyBytes& key, BehaviorList& behaviors);
  static void pass_loads(KeyBytes& key, World& world);

  PageStore::Image bullet_, kept_, live_, own_;
  std::size_t own_size_ = 0;
};

}  // namespace limber
