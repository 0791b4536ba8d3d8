// RouteLink: finding the two ends, and pairing them.
#include "sim/routes/route_link.h"

#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "properties/path_matcher.h"
#include "sim/routes/own_axis.h"

namespace limber::sim {

namespace {

constexpr std::size_t kMaxAddress = 512;  // bytes

struct SplitAddress {
  std::string_view path;
  std::string_view component;  // without the dot; empty: none
};

// The last name of an address is that of a property, which has no dot.
SplitAddress split_address(std::string_view address) {
  const std::size_t dot = address.rfind('.');
  const std::size_t slash = address.rfind('/');
  if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash)) return {address, {}};
  return {address.substr(0, dot), address.substr(dot + 1)};
}

Result<std::int8_t> component_of(const Property& property, std::string_view name, bool is_source) {
  constexpr std::array<std::string_view, 4> kNames{"x", "y", "z", "w"};
  if (name.empty()) return RouteEnd::kAll;
  if (property.width == 1) return Error{fmt::format("{} is a single number, without components", property.name)};
  for (std::size_t i = 0; i < property.width; i++) {
    if (name == kNames[i]) return static_cast<std::int8_t>(i);
  }
  const bool has_length = is_source && property.type == PropertyType::vec3;
  if (has_length && name == "length") return RouteEnd::kLength;
  return Error{fmt::format("{} has no component '{}', only {}{}", property.name, printable(name),
                           property.width == 4 ? "x, y, z and w" : "x, y and z", has_length ? ", and length" : "")};
}

// Why a property can't be an end; none if it can.
std::optional<std::string> unsuitable_text(const PropertyRef& ref, bool is_source) {
  if (ref.property == nullptr) return "this is an object, not a property";
  const Property& property = *ref.property;
  if (property.kind == PropertyKind::action) return fmt::format("{} is an action, without a value", property.name);
  if (property.type == PropertyType::text) return fmt::format("{} is a text, not a number", property.name);
  if (!is_source && !property.writable()) return fmt::format("{} is read-only", property.name);
  return {};
}

Result<std::vector<PropertyRef>> find_refs(const Store& store, std::string_view path, bool hint) {
  if (!is_address_pattern(path)) {
    const Result<PropertyRef> ref = find_property(store, path, hint);
    if (!ref) return Error{ref.error()};
    return std::vector{*ref};
  }
  PatternBudget budget;
  Result<std::vector<PropertyRef>> refs = match_properties(store, path, budget, kMaxRouteLinks + 1);
  if (refs && refs->size() > kMaxRouteLinks)
    return Error{fmt::format("the pattern matches more than {} properties", kMaxRouteLinks)};
  return refs;
}

Result<std::vector<RouteEnd>> find_ends(const Store& store, std::string_view address, bool is_source, bool hint) {
  const SplitAddress split = split_address(address);
  const auto error = [&](std::string_view why) { return Error{fmt::format("{}: {}", printable(address), why)}; };
  const Result<std::vector<PropertyRef>> refs = find_refs(store, split.path, hint);
  if (!refs) return error(refs.error());
  std::vector<RouteEnd> ends;
  std::string first_error = "the pattern matches nothing";
  bool is_first = true;
  for (const PropertyRef& ref : *refs) {
    std::optional<std::string> why = unsuitable_text(ref, is_source);
    Result<std::int8_t> component = RouteEnd::kAll;
    if (!why) {
      component = component_of(*ref.property, split.component, is_source);
      if (!component) why = component.error();
    }
    if (why) {
      if (std::exchange(is_first, false)) first_error = *why;
      continue;
    }
    RouteEnd& end = ends.emplace_back(RouteEnd{ref, *component});
    if (end.component != RouteEnd::kAll || !ref.property->own_axis) continue;
    if (const int axis = own_axis_index(store, ref.node, *ref.property); axis >= 0)
      end.component = static_cast<std::int8_t>(axis);
  }
  if (ends.empty()) return error(first_error);
  return ends;
}

std::string width_text(const RouteEnd& end) {
  return fmt::format("{} has {}", end.ref.property->name, counted(end.width(), "number"));
}

Result<void> check_widths(const RouteLink& link) {
  const std::uint32_t from = link.from.width();
  const std::uint32_t to = link.to.width();
  if (from == to || (from == 1 && link.to.ref.property->type == PropertyType::flags3)) return {};
  const bool at_source = to == 1;
  return Error{fmt::format("{}, {}: give a component of {}, such as .x{}", width_text(link.from), width_text(link.to),
                           (at_source ? link.from : link.to).ref.property->name, at_source ? " or .length" : "")};
}

}  // namespace

Result<void> check_route_address(std::string_view subject, std::string_view address) {
  if (address.size() > kMaxAddress)
    return Error{fmt::format("{}: an address has at most {} bytes", subject, kMaxAddress)};
  if (printable(address) != address)
    return Error{fmt::format("{}: '{}' contains characters that can't be printed", subject, printable(address))};
  if (!address.starts_with('/'))
    return Error{fmt::format("{}: '{}' is not an address: it must begin with /", subject, address)};
  return {};
}

Result<std::vector<RouteLink>> find_route_links(const Store& store, std::string_view from, std::string_view to,
                                                bool hint) {
  const Result<std::vector<RouteEnd>> sources = find_ends(store, from, true, hint);
  if (!sources) return Error{"from " + sources.error()};
  const Result<std::vector<RouteEnd>> targets = find_ends(store, to, false, hint);
  if (!targets) return Error{"to " + targets.error()};
  const std::size_t n = sources->size();
  const std::size_t m = targets->size();
  if (n != m && n != 1 && m != 1) {
    return Error{
        fmt::format("from matches {} properties and to {}: a route connects one to many, many to one, or as "
                    "many to as many",
                    n, m)};
  }
  std::vector<RouteLink> links;
  for (std::size_t i = 0; i < std::max(n, m); i++) {
    const RouteLink& link = links.emplace_back(RouteLink{(*sources)[n == 1 ? 0 : i], (*targets)[m == 1 ? 0 : i], 0});
    if (const Result<void> fits = check_widths(link); !fits) return Error{fits.error()};
  }
  return links;
}

}  // namespace limber::sim
