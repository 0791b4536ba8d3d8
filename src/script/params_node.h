// ParamsNode: a scene's own parameters (`params { … }`) as the node /scene of the store. [sim]
#pragma once

#include <span>
#include <vector>

#include "params/store.h"
#include "script/run_inputs.h"

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

  /// The rows with the values in force.
  std::vector<LiveParam> live() const;
  /// Takes over what the parameters of the run before hold: a value whose default stayed, within the new range and
  /// choices. An edited default or another type starts at the default: these are the answer, a bit a row.
  std::uint64_t keep(std::span<const LiveParam> before);

 private:
  Store& store_;
  NodeId id_;
};

}  // namespace limber
