// Look: how the picture is lit and what its stage is like, as rows. Nothing here draws. [sim]
#pragma once

#include "params/store.h"

namespace limber {

class Look {
 public:
  static const Table& table();

  Look(Store& store, NodeId parent) : store_(store), id_(store.add(table(), parent, "look", this)) {}
  NodeId id() const { return id_; }

 private:
  Result<void> act_prefer(std::span<const double> args);

  Store& store_;
  NodeId id_;
};

}  // namespace limber
