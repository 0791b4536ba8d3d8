// ParamsNode: a scene's own parameters (`params { … }`) as the node /scene of the store. [sim]
#pragma once

#include <vector>

#include "base/vec.h"
#include "params/store.h"

namespace limber {

class ParamsNode {
 public:
  /// Bounds of each number of a row: vec3 rows may have other ones for each axis, which a Row does not know.
  struct Range {
    Vec3 low;
    Vec3 high;
  };

  /// Adds /scene with these rows (at most 64, no two alike by the naming rule). Their effects are set here.
  ParamsNode(Store& store, std::vector<Row> rows, std::vector<Range> ranges);
  ~ParamsNode();
  ParamsNode(const ParamsNode&) = delete;
  ParamsNode& operator=(const ParamsNode&) = delete;

  NodeId id() const { return id_; }
  const Table& table() const { return store_.table(id_); }

 private:
  void clamp();

  Store& store_;
  NodeId id_;
  std::vector<Range> ranges_;
};

}  // namespace limber
