// Names in messages to things.
#include "engine/select.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

// a name as text without a copy, where it is text; `buffer` holds a number's
std::string_view view_of(const Arg& name, std::string& buffer) {
  if (name.is_text()) return name.text;
  buffer = number_text(name.number);
  return buffer;
}

}  // namespace

std::string Selector::text(const Arg& name) { return name.is_text() ? name.text : number_text(name.number); }

bool Selector::single(std::span<const Arg> names, std::size_t count) {
  if (names.size() != count) return false;
  for (const Arg& name : names) {
    if (name.is_text() && is_pattern(name.text)) return false;
  }
  return true;
}

void Selector::add(const Body& body, const Table& table, const Row& row, std::string_view element,
                   std::vector<Place>& out) const {
  const Store& store = world_.store();
  const NodeId group = store.child(body.id(), table.name());
  if (!element.empty() && !is_pattern(element)) {
    const NodeId id = store.child(group, element);
    if (!id.null()) out.push_back({id, &row});
    return;
  }
  for (const NodeId id : store.children(group)) {
    if (work_.over()) return;
    if (element.empty() || work_.match(element, store.name(id))) out.push_back({id, &row});
  }
}

Result<void> Selector::select(const Table& table, const Row& row, std::span<const Arg> names,
                              std::vector<Place>& out) const {
  std::string buffers[2];
  const std::string_view first = names.empty() ? "*" : view_of(names[0], buffers[0]);
  const std::string_view second = names.size() < 2 ? "" : view_of(names[1], buffers[1]);
  bool body_found = false;
  if (!is_pattern(first)) {
    if (const Body* body = world_.find_body(first)) {
      body_found = true;
      add(*body, table, row, second, out);
    }
  } else {
    for (const auto& body : world_.bodies()) {
      if (work_.over()) break;
      if (!names.empty() && !work_.match(first, body->name())) continue;
      body_found = true;
      add(*body, table, row, second, out);
    }
  }
  // one name that is no body's: an element's, wherever it is
  if (names.size() == 1 && !body_found) {
    for (const auto& body : world_.bodies()) add(*body, table, row, first, out);
  }
  if (work_.over()) return too_much();
  if (!out.empty() || names.empty()) return {};
  if (names.size() == 2) return nothing_in(table.name(), first, second);
  if (body_found) return Error{fmt::format("body '{}' has no {}s", printable(first), table.name())};
  return nothing_called(table.name(), first);
}

Result<void> Selector::select_behaviors(std::span<const Arg> names, const Arg& parameter,
                                        std::vector<Place>& out) const {
  std::string buffers[3];
  const std::string_view body_name = names.size() == 2 ? view_of(names[0], buffers[0]) : "*";
  const std::string_view name = view_of(names.back(), buffers[1]);
  const std::string_view wanted = view_of(parameter, buffers[2]);
  const Behavior* without = nullptr;
  const auto take = [&](const Behavior& behavior) {
    const Row* const row = behavior.type().table->find(wanted);
    if (row != nullptr && row->writable()) {
      out.push_back({behavior.id(), row});
    } else {
      without = &behavior;
    }
  };
  const auto look_in = [&](const Body& body) {
    if (!is_pattern(name)) {
      if (const Behavior* behavior = body.find_behavior(name)) take(*behavior);
      return;
    }
    for (const Behavior* behavior : body.behaviors()) {
      if (work_.match(name, behavior->name())) take(*behavior);
    }
  };
  if (!is_pattern(body_name)) {
    if (const Body* body = world_.find_body(body_name)) look_in(*body);
  } else {
    for (const auto& body : world_.bodies()) {
      if (work_.over()) break;
      if (names.size() < 2 || work_.match(body_name, body->name())) look_in(*body);
    }
  }
  if (work_.over()) return too_much();
  if (!out.empty()) return {};
  if (without != nullptr) return no_parameter(*without, wanted);
  if (names.size() == 2) return nothing_in("behavior", body_name, name);
  std::vector<std::string_view> near;
  for (const auto& body : world_.bodies()) {
    for (const Behavior* behavior : body->behaviors()) {
      if (std::find(near.begin(), near.end(), behavior->name()) == near.end()) near.push_back(behavior->name());
    }
  }
  return Error{fmt::format("there is no behavior '{}'{}", printable(name), hint(name, near))};
}

Result<void> Selector::select_shapes(const Row& row, std::span<const Arg> names, std::vector<Place>& out) const {
  std::string buffer;
  const std::string_view name = names.empty() ? "*" : view_of(names[0], buffer);
  if (!is_pattern(name)) {
    if (const Shape* shape = world_.find_shape(name)) out.push_back({shape->id(), &row});
  } else {
    for (const auto& shape : world_.shapes()) {
      if (work_.over()) return too_much();
      if (names.empty() || work_.match(name, shape->name())) out.push_back({shape->id(), &row});
    }
  }
  if (!out.empty() || names.empty()) return {};
  if (is_pattern(name)) return Error{fmt::format("no shape matches '{}'", printable(name))};
  std::vector<std::string_view> near;
  for (const auto& shape : world_.shapes()) near.push_back(shape->name());
  return Error{fmt::format("there is no shape '{}'{}", printable(name), hint(name, near))};
}

Error Selector::too_much() {
  return Error{"this is too much work for patterns; name more exactly, or send fewer at a time"};
}

Error Selector::no_parameter(const Behavior& behavior, std::string_view parameter) const {
  std::vector<std::string_view> near;
  for (const Row& row : behavior.type().table->rows()) {
    if (row.writable()) near.push_back(row.name);
  }
  return Error{fmt::format("behavior '{}/{}' ({}) has no parameter '{}'{}", behavior.body().name(), behavior.name(),
                           behavior.type().name, printable(parameter), hint(parameter, near))};
}

Error Selector::nothing_called(std::string_view kind, std::string_view name) const {
  if (is_pattern(name)) return Error{fmt::format("no body and no {} matches '{}'", kind, printable(name))};
  std::vector<std::string_view> near = world_.body_names();
  if (!world_.bodies().empty()) add_names(*world_.bodies().front(), kind, near);
  return Error{fmt::format("there is no body or {} '{}'{}", kind, printable(name), hint(name, near))};
}

Error Selector::nothing_in(std::string_view kind, std::string_view body, std::string_view element) const {
  const Body* found = world_.find_body(body);
  if (found == nullptr && !is_pattern(body))
    return Error{fmt::format("there is no body '{}'{}", printable(body), hint(body, world_.body_names()))};
  if (found == nullptr || is_pattern(element))
    return Error{fmt::format("no {} matches '{}' in '{}'", kind, printable(element), printable(body))};
  std::vector<std::string_view> near;
  add_names(*found, kind, near);
  return Error{fmt::format("no {} '{}' in '{}'{}", kind, printable(element), printable(body), hint(element, near))};
}

void Selector::add_names(const Body& body, std::string_view kind, std::vector<std::string_view>& out) const {
  const Store& store = world_.store();
  for (const NodeId id : store.children(store.child(body.id(), kind))) out.push_back(store.name(id));
}

std::string Selector::hint(std::string_view written, const std::vector<std::string_view>& names) const {
  return hints_.take() ? name_hint(written, names) : "";
}

}  // namespace limber
