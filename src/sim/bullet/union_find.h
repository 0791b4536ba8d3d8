// UnionFind: disjoint sets of the indices 0, 1, … (path halving, without ranks). Memory is reused.
#pragma once

#include "sim/bullet/bullet.h"

namespace limber::sim::bullet {

class UnionFind {
 public:
  /// Makes `count` sets of one index each.
  void reset(int count) {
    parent_.resizeNoInitialize(count);
    for (int i = 0; i < count; ++i) parent_[i] = i;
  }
  /// Copies the sets of another one.
  void assign(const UnionFind& other) { parent_.copyFromArray(other.parent_); }
  /// Returns an index that identifies the set.
  int root(int index) {
    while (parent_[index] != index) index = parent_[index] = parent_[parent_[index]];
    return index;
  }
  /// Unites two sets; a negative index is in none.
  void unite(int a, int b) {
    if (a >= 0 && b >= 0) parent_[root(a)] = root(b);
  }

 private:
  btAlignedObjectArray<int> parent_;
};

}  // namespace limber::sim::bullet
