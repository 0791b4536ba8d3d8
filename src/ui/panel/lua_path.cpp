// Builds the expression from the names of the path.
#include "ui/panel/lua_path.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace limber::panel {

std::string lua_text(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

namespace {

// The expression of an object below /visuals.
std::string visuals_text(const std::vector<std::string_view>& names) {
  const std::size_t n = names.size();
  if (n == 1) return "visuals";
  if (names[1] == "shape") return n == 3 ? fmt::format("visuals:shape({})", lua_text(names[2])) : std::string();
  return n == 2 ? fmt::format("visuals.{}", names[1]) : std::string();
}

// The expression of an object below /physics.
std::string physics_text(const std::vector<std::string_view>& names) {
  const std::size_t n = names.size();
  if (n == 2) return names[1] == "sim" ? "sim" : "";
  if (n < 3) return {};
  const std::string name = lua_text(names[2]);
  if (n == 3 && names[1] == "group") return fmt::format("sim:group_behavior({})", name);
  if (n == 3 && names[1] == "gear") return fmt::format("sim:gear({})", name);
  if (n == 3 && names[1] == "route") return fmt::format("sim:route({})", name);
  if (names[1] != "body") return {};
  if (n == 3) return fmt::format("sim:body({})", name);
  return n == 5 ? fmt::format("sim:body({}):{}({})", name, names[3], lua_text(names[4])) : std::string();
}

// Returns the expression of an object; empty if Lua has no equivalent.
std::string object_text(const std::vector<std::string_view>& names) {
  if (names.empty()) return {};
  if (names[0] == "physics") return physics_text(names);
  if (names[0] == "visuals") return visuals_text(names);
  if (names[0] == "lighting" && names.size() == 3) return fmt::format("sim:fixture({})", lua_text(names[2]));
  return names[0] == "scene" && names.size() == 1 ? "params" : "";
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

}  // namespace limber::panel
