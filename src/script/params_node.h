// ParamsNode: a scene's own parameters (`params { … }`) as the node /scene of the store. [sim]
#pragma once

#include <vector>

#include "params/store.h"

namespace limber {

class ParamsNode {
 public:
  /// Adds /scene with these rows (at most 64, no two alike by the naming rule).
  ParamsNode(Store& store, std::vector<Row> rows);
  ~ParamsNode();
  ParamsNode(const ParamsNode&) = delete;
  ParamsNode& operator=(const ParamsNode&) = delete;

  NodeId id() const { return id_; }
  const Table& table() const { return store_.table(id_); }

 private:
  Store& store_;
  NodeId id_;
};

}  // namespace limber
