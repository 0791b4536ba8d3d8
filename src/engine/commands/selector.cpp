// Selector: names in messages to objects.
#include "engine/commands/selector.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/behavior/behavior.h"
#include "sim/shapes/shape_list.h"
#include "sim/world/body.h"

namespace limber::engine {

namespace {

// Returns a name without a copy if it is text; a number is formatted into `buffer`.
std::string_view view_of(const Arg& name, std::string& buffer) {
  if (name.is_text()) return name.text;
  buffer = number_text(name.number);
  return buffer;
}

}  // namespace

std::string Selector::name_text(const Arg& name) { return name.is_text() ? name.text : number_text(name.number); }

bool Selector::is_single(std::span<const Arg> names, std::size_t count) {
  if (names.size() != count) return false;
  for (const Arg& name : names) {
    if (name.is_text() && is_pattern(name.text)) return false;
  }
  return true;
}

void Selector::add_elements(const sim::Body& body, const PropertyTable& table, const Property& property,
                            std::string_view element, std::vector<PropertyRef>& out) const {
  const Store& store = world_.store();
  const NodeId group = store.child(body.id(), table.name());
  if (!element.empty() && !is_pattern(element)) {
    const NodeId id = store.child(group, element);
    if (!id.null()) out.push_back({id, &property});
    return;
  }
  for (const NodeId id : store.children(group)) {
    if (budget_.exceeded()) return;
    if (element.empty() || budget_.match(element, store.name(id))) out.push_back({id, &property});
  }
}

template <class Visit>
bool Selector::visit_bodies(std::string_view name, bool any, Visit visit) const {
  bool found = false;
  if (!is_pattern(name)) {
    const sim::Body* const body = world_.find_body(name);
    if (body != nullptr) visit(*body);
    return body != nullptr;
  }
  for (const auto& body : world_.bodies()) {
    if (budget_.exceeded()) break;
    if (!any && !budget_.match(name, body->name())) continue;
    found = true;
    visit(*body);
  }
  return found;
}

Result<void> Selector::select(const PropertyTable& table, const Property& property, std::span<const Arg> names,
                              std::vector<PropertyRef>& out) const {
  std::string buffers[2];
  const std::string_view first = names.empty() ? "*" : view_of(names[0], buffers[0]);
  const std::string_view second = names.size() < 2 ? "" : view_of(names[1], buffers[1]);
  const bool body_found = visit_bodies(
      first, names.empty(), [&](const sim::Body& body) { add_elements(body, table, property, second, out); });
  // a single name that is not a body: an element in any body
  if (names.size() == 1 && !body_found) {
    for (const auto& body : world_.bodies()) add_elements(*body, table, property, first, out);
  }
  if (budget_.exceeded()) return budget_exceeded();
  if (!out.empty() || names.empty()) return {};
  if (names.size() == 2) return no_such_element(table.name(), first, second);
  if (body_found) return Error{fmt::format("body '{}' has no {}s", printable(first), table.name())};
  return no_such_name(table.name(), first);
}

Result<void> Selector::select_behaviors(std::span<const Arg> names, const Arg& parameter,
                                        std::vector<PropertyRef>& out) const {
  std::string buffers[3];
  const std::string_view body_name = names.size() == 2 ? view_of(names[0], buffers[0]) : "*";
  const std::string_view name = view_of(names.back(), buffers[1]);
  const std::string_view parameter_name = view_of(parameter, buffers[2]);
  const sim::Behavior* without_parameter = nullptr;
  const auto add = [&](const sim::Behavior& behavior) {
    const Property* const property = behavior.type().table->find(parameter_name);
    if (property != nullptr && property->writable()) {
      out.push_back({behavior.id(), property});
    } else {
      without_parameter = &behavior;
    }
  };
  visit_bodies(body_name, names.size() < 2, [&](const sim::Body& body) {
    if (!is_pattern(name)) {
      if (const sim::Behavior* behavior = body.behaviors().find(name)) add(*behavior);
      return;
    }
    for (const sim::Behavior* behavior : body.behaviors().list()) {
      if (budget_.match(name, behavior->name())) add(*behavior);
    }
  });
  if (budget_.exceeded()) return budget_exceeded();
  if (!out.empty()) return {};
  if (without_parameter != nullptr) return no_parameter(*without_parameter, parameter_name);
  return names.size() == 2 ? no_such_element("behavior", body_name, name) : no_such_behavior(name);
}

Result<void> Selector::select_shapes(const Property& property, std::span<const Arg> names,
                                     std::vector<PropertyRef>& out) const {
  std::string buffer;
  const std::string_view name = names.empty() ? "*" : view_of(names[0], buffer);
  if (!is_pattern(name)) {
    if (const sim::Shape* shape = world_.shapes().find(name)) out.push_back({shape->id(), &property});
  } else {
    for (const auto& shape : world_.shapes().list()) {
      if (budget_.exceeded()) return budget_exceeded();
      if (names.empty() || budget_.match(name, shape->name())) out.push_back({shape->id(), &property});
    }
  }
  if (!out.empty() || names.empty()) return {};
  if (is_pattern(name)) return Error{fmt::format("no shape matches '{}'", printable(name))};
  std::vector<std::string_view> candidates;
  for (const auto& shape : world_.shapes().list()) candidates.push_back(shape->name());
  return Error{fmt::format("there is no shape '{}'{}", printable(name), hint(name, candidates))};
}

Error Selector::budget_exceeded() {
  return Error{"the patterns need too much work; use more specific names, or send fewer messages at a time"};
}

Error Selector::no_parameter(const sim::Behavior& behavior, std::string_view parameter) const {
  std::vector<std::string_view> candidates;
  for (const Property& property : behavior.type().table->properties()) {
    if (property.writable()) candidates.push_back(property.name);
  }
  return Error{fmt::format("behavior '{}/{}' ({}) has no parameter '{}'{}", behavior.body().name(), behavior.name(),
                           behavior.type().name, printable(parameter), hint(parameter, candidates))};
}

Error Selector::no_such_behavior(std::string_view name) const {
  std::vector<std::string_view> candidates;
  for (const auto& body : world_.bodies()) {
    for (const sim::Behavior* behavior : body->behaviors().list()) {
      if (std::find(candidates.begin(), candidates.end(), behavior->name()) == candidates.end())
        candidates.push_back(behavior->name());
    }
  }
  return Error{fmt::format("there is no behavior '{}'{}", printable(name), hint(name, candidates))};
}

Error Selector::no_such_name(std::string_view kind, std::string_view name) const {
  if (is_pattern(name)) return Error{fmt::format("no body and no {} matches '{}'", kind, printable(name))};
  std::vector<std::string_view> candidates = world_.body_names();
  if (!world_.bodies().empty()) add_names(*world_.bodies().front(), kind, candidates);
  return Error{fmt::format("there is no body or {} '{}'{}", kind, printable(name), hint(name, candidates))};
}

Error Selector::no_such_element(std::string_view kind, std::string_view body, std::string_view element) const {
  const sim::Body* found = world_.find_body(body);
  if (found == nullptr && !is_pattern(body))
    return Error{fmt::format("there is no body '{}'{}", printable(body), hint(body, world_.body_names()))};
  if (found == nullptr || is_pattern(element))
    return Error{fmt::format("no {} matches '{}' in '{}'", kind, printable(element), printable(body))};
  std::vector<std::string_view> candidates;
  add_names(*found, kind, candidates);
  return Error{
      fmt::format("no {} '{}' in '{}'{}", kind, printable(element), printable(body), hint(element, candidates))};
}

void Selector::add_names(const sim::Body& body, std::string_view kind, std::vector<std::string_view>& out) const {
  const Store& store = world_.store();
  for (const NodeId id : store.children(store.child(body.id(), kind))) out.push_back(store.name(id));
}

std::string Selector::hint(std::string_view name, const std::vector<std::string_view>& names) const {
  return hints_.consume() ? name_hint(name, names) : "";
}

}  // namespace limber::engine
