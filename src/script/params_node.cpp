// The node /scene.
#include "script/params_node.h"

namespace limber {

ParamsNode::ParamsNode(Store& store, std::vector<Row> rows)
    : store_(store), id_(store.add(shared_table("scene", "/scene", std::move(rows)), store.root(), "scene", this)) {}

ParamsNode::~ParamsNode() { store_.remove(id_); }

}  // namespace limber
