// BulletMemory: where Bullet keeps what a world has (bodies, joints, pairs, contacts, trees), in one arena, so that a
// key state is a copy of it and holds whatever Bullet remembers, in its order and at its addresses.
#pragma once

#include "base/arena.h"

namespace limber {

class BulletMemory {
 public:
  /// Bullet asks us for memory from the first one on.
  BulletMemory();

  Arena& arena() { return arena_; }
  const Arena& arena() const { return arena_; }

  /// While one lives, what Bullet takes on this thread lies there; null: on the heap. Shapes, which worlds share, and
  /// what a step leaves behind for nobody, do.
  class Scope {
   public:
    explicit Scope(BulletMemory* memory);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    BulletMemory* before_;
  };
  /// Of the innermost Scope here; null: none.
  static BulletMemory* current();

 private:
  Arena arena_;
};

}  // namespace limber
