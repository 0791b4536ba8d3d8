// ConsoleParams: scene parameters set by a console evaluation.
#include "engine/commands/console_params.h"

#include <fmt/format.h>

namespace limber::engine {

namespace {

Message message_of(const Store& store, NodeId id, const Property& property) {
  Message message{fmt::format("{}/{}", store.path(id), property.name), {}};
  const double* const values = store.values(id, property);
  for (std::uint32_t i = 0; i < property.width; i++) {
    if (property.type == PropertyType::choice) {
      message.args.push_back(Arg::of(property.choices[static_cast<std::size_t>(values[i])]));
    } else if (property.type == PropertyType::boolean) {
      message.args.push_back(Arg::of(values[i] != 0));
    } else {
      message.args.push_back(Arg::of(values[i]));
    }
  }
  return message;
}

}  // namespace

ConsoleParams::ConsoleParams(Store& store, NodeId params) : store_(store), params_(params) {
  const auto on_write = [](void* self, NodeId id, const Property& property, bool over_time, const double* old_values) {
    static_cast<ConsoleParams*>(self)->on_write(id, property, over_time, old_values);
  };
  previous_ = store.set_listener({on_write, this});
}

ConsoleParams::~ConsoleParams() { store_.set_listener(previous_); }

void ConsoleParams::on_write(NodeId id, const Property& property, bool over_time, const double* old_values) {
  if (id == params_) written_ |= std::uint64_t{1} << property.index;
  if (previous_.callback != nullptr) previous_.callback(previous_.context, id, property, over_time, old_values);
}

void ConsoleParams::add_to(Overrides& overrides) const {
  if (written_ == 0 || !store_.alive(params_)) return;
  for (const Property& property : store_.table(params_).properties()) {
    if ((written_ >> property.index & 1u) != 0) overrides.add(message_of(store_, params_, property));
  }
}

}  // namespace limber::engine
