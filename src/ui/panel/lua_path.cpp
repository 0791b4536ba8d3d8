// Builds the expression from the names of the path.
#include "ui/panel/lua_path.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace limber {

std::string lua_text(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

namespace {

// Returns the expression of an object; empty if Lua has no equivalent.
std::string object_text(const std::vector<std::string_view>& names) {
  const auto is = [&](std::size_t i, std::string_view name) { return i < names.size() && names[i] == name; };
  const std::size_t n = names.size();
  if (is(0, "scene") && n == 1) return "params";
  if (is(0, "physics") && is(1, "sim") && n == 2) return "sim";
  if (is(0, "physics") && is(1, "group") && n == 3) return fmt::format("sim:group_behavior({})", lua_text(names[2]));
  if (is(0, "physics") && is(1, "gear") && n == 3) return fmt::format("sim:gear({})", lua_text(names[2]));
  if (is(0, "visuals") && n == 1) return "visuals";
  if (is(0, "visuals") && is(1, "shape") && n == 3) return fmt::format("visuals:shape({})", lua_text(names[2]));
  if (is(0, "visuals") && n == 2 && !is(1, "shape")) return fmt::format("visuals.{}", names[1]);
  if (!is(0, "physics") || !is(1, "body") || n < 3) return {};
  std::string body = fmt::format("sim:body({})", lua_text(names[2]));
  if (n == 3) return body;
  return n == 5 ? fmt::format("{}:{}({})", body, names[3], lua_text(names[4])) : std::string();
}

}  // namespace

std::string lua_path(const TreeSnapshot& tree, const TreePropertyRef& ref) {
  std::vector<std::string_view> names;
  for (std::uint32_t at = ref.node; at != 0; at = tree.nodes()[at].parent) names.push_back(tree.name(at));
  std::reverse(names.begin(), names.end());
  std::string object = object_text(names);
  if (ref.property == nullptr || object.empty()) return object;
  if (ref.property->kind != PropertyKind::action) return fmt::format("{}.{}", object, ref.property->name);
  return ref.property->min_args == 0 ? fmt::format("{}:{}()", object, ref.property->name) : std::string();
}

}  // namespace limber
