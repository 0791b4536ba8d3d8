// BulletMemory: one arena for all of Bullet's persistent data of a world (bodies, joints, pairs, contacts, trees), so
// that a checkpoint is a copy of it, with the same order and addresses.
#pragma once

#include "base/memory/arena.h"

namespace limber::sim::bullet {

class BulletMemory {
 public:
  /// Installs the allocator hooks of Bullet when first called.
  BulletMemory();

  Arena& arena() { return arena_; }
  const Arena& arena() const { return arena_; }

  /// While it exists, Bullet's allocations on this thread come from that memory; null: from the heap, which is used for
  /// shapes (shared by worlds) and data that doesn't outlive a step.
  class Scope {
   public:
    explicit Scope(BulletMemory* memory);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    BulletMemory* previous_;
  };
  /// Memory of the innermost Scope on this thread; null: none.
  static BulletMemory* current();

 private:
  Arena arena_;
};

}  // namespace limber::sim::bullet
