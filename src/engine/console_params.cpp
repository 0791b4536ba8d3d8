// What a console's text has set of `params`.
#include "engine/console_params.h"

#include <fmt/format.h>

namespace limber {

namespace {

Message message_of(const Store& store, NodeId id, const Row& row) {
  Message message{fmt::format("{}/{}", store.path(id), row.name), {}};
  const double* const values = store.values(id, row);
  for (std::uint32_t i = 0; i < row.width; i++) {
    if (row.type == RowType::choice) {
      message.args.push_back(Arg::of(row.choices[static_cast<std::size_t>(values[i])]));
    } else if (row.type == RowType::boolean) {
      message.args.push_back(Arg::of(values[i] != 0));
    } else {
      message.args.push_back(Arg::of(values[i]));
    }
  }
  return message;
}

}  // namespace

ConsoleParams::ConsoleParams(Store& store, NodeId params) : store_(store), params_(params) {
  const auto heard = [](void* who, NodeId id, const Row& row, bool later, const double* before) {
    static_cast<ConsoleParams*>(who)->heard(id, row, later, before);
  };
  outer_ = store.listen({heard, this});
}

ConsoleParams::~ConsoleParams() { store_.listen(outer_); }

void ConsoleParams::heard(NodeId id, const Row& row, bool later, const double* before) {
  if (id == params_) rows_ |= std::uint64_t{1} << row.index;
  if (outer_.heard != nullptr) outer_.heard(outer_.who, id, row, later, before);
}

void ConsoleParams::remember(PerformerHand& hand) const {
  if (rows_ == 0 || !store_.alive(params_)) return;
  for (const Row& row : store_.table(params_).rows()) {
    if ((rows_ >> row.index & 1u) != 0) hand.remember(message_of(store_, params_, row));
  }
}

}  // namespace limber
