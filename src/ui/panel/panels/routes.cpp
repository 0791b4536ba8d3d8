// Routes: a list of all routes with their present input and output, to enable, select and remove them; fields to add a
// route or to connect one otherwise. The settings of the selected route are in the parameters.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/lua_text.h"
#include "base/text.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

namespace {

constexpr const char* kRoutes = "/physics/route";

struct RouteEntry {
  std::uint32_t node = 0;
  std::string name;
  std::string path;
};

class RoutesPanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    const std::size_t count = entries_of(context).size();
    return count == 0 ? "" : fmt::format("{}", count);
  }

  // Selects a route that was added, once it exists, and puts the ends that were chosen in the menu of a property into
  // the fields.
  void update(GuiContext& context) override {
    if (!added_.empty() && is_known(context, added_)) {
      context.select(fmt::format("{}/{}", kRoutes, escape_name(std::exchange(added_, {}))));
    }
    std::string from = std::exchange(context.requests.route_from, {});
    std::string to = std::exchange(context.requests.route_to, {});
    if (from.empty() && to.empty()) return;
    if (!from.empty()) from_ = std::move(from);
    if (!to.empty()) to_ = std::move(to);
    if (name_.empty() || is_known(context, name_)) name_ = free_name(context);
    context.show_notice(from_.empty() || to_.empty() ? "Now choose the other end of the route"
                                                     : "Both ends are chosen: add the route in the panel Routes");
  }

  void draw(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    draw_fields(context);
    if (!ImGui::BeginChild("##list", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    const std::vector<RouteEntry> entries = entries_of(context);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(entries.size()), line_height());
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++)
        draw_route(context, entries[static_cast<std::size_t>(i)]);
    }
    if (entries.empty()) ImGui::TextDisabled("No routes: right click two values and choose From and To");
    ImGui::EndChild();
  }

 private:
  static float line_height() {
    return ImGui::GetFrameHeight() + ImGui::GetTextLineHeight() + ImGui::GetStyle().ItemSpacing.y;
  }

  static std::vector<RouteEntry> entries_of(const GuiContext& context) {
    std::vector<RouteEntry> entries;
    if (context.value_snapshot == nullptr) return entries;
    const TreeSnapshot& tree = *context.value_snapshot->tree;
    const Result<TreePropertyRef> group = tree.find(kRoutes);
    if (!group) return entries;
    tree.each_child(group->node, [&](std::uint32_t node) {
      entries.push_back({node, std::string(tree.name(node)), tree.path(node)});
      return true;
    });
    return entries;
  }

  static bool is_known(const GuiContext& context, const std::string& name) {
    const std::vector<RouteEntry> entries = entries_of(context);
    return std::ranges::any_of(entries, [&](const RouteEntry& entry) { return entry.name == name; });
  }

  static std::string free_name(const GuiContext& context) {
    for (std::size_t number = entries_of(context).size() + 1;; number++) {
      std::string name = fmt::format("route_{}", number);
      if (!is_known(context, name)) return name;
    }
  }

  static PropertyHandle handle_of(const GuiContext& context, const RouteEntry& entry, const char* property) {
    const PropertyTable& table = *context.value_snapshot->tree->nodes()[entry.node].table;
    return {{entry.node, &table.at(property)}, fmt::format("{}/{}", entry.path, property)};
  }

  static std::string text_of(const GuiContext& context, const RouteEntry& entry, const char* property) {
    return std::string(context.text(handle_of(context, entry, property).ref));
  }

  static double number_of(const GuiContext& context, const RouteEntry& entry, const char* property) {
    PendingValues::Values values{};
    context.values(handle_of(context, entry, property), values);
    return values[0];
  }

  static void text_field(GuiContext& context, const char* name, const char* hint, const char* tooltip,
                         std::string& text, float width) {
    ImGui::SetNextItemWidth(width);
    ImGui::PushID(name);
    ImGui::InputTextWithHint("##text", hint, &text);
    ImGui::PopID();
    context.names.add(name);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
      ImGui::SetTooltip("%s%s%s", tooltip, text.empty() ? "" : "\n", text.c_str());
  }

  void draw_fields(GuiContext& context) {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float side = ImGui::GetFrameHeight();
    const float width = ImGui::GetContentRegionAvail().x;
    const float copy = text_width("Copy Lua") + 2 * ImGui::GetStyle().FramePadding.x;
    text_field(context, "routes.name", "Name", "Name of the route", name_, width - copy - side - 2 * gap);
    ImGui::SameLine(0, gap);
    const bool known = is_known(context, name_);
    ImGui::BeginDisabled(name_.empty() || from_.empty() || to_.empty());
    if (icon_button(context.names, "routes.add", Icon::plus,
                    known ? "Connect the route of this name to these addresses" : "Add the route", false, side))
      add(context);
    ImGui::EndDisabled();
    ImGui::SameLine(0, gap);
    if (ImGui::Button("Copy Lua", {copy, side})) context.copy_with_notice(lua_of_all(context));
    context.names.add("routes.copy");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Copy all routes as lines of Lua, to paste them into the scene's file");
    const float half = (width - gap) / 2;
    text_field(context, "routes.from", "From: address", "Address or pattern of the source, such as /physics/sim/time",
               from_, half);
    ImGui::SameLine(0, gap);
    text_field(context, "routes.to", "To: address", "Address or pattern of the target, which the route sets", to_,
               half);
  }

  // The lines that make the routes with their present settings.
  static std::string lua_of_all(const GuiContext& context) {
    std::string lines;
    for (const RouteEntry& entry : entries_of(context)) {
      lines += fmt::format("sim:add_route({}, {{ from = {}, to = {}{} }})\n", lua_string(entry.name),
                           lua_string(text_of(context, entry, "from")), lua_string(text_of(context, entry, "to")),
                           settings_of(context, entry));
    }
    return lines;
  }

  static std::string settings_of(const GuiContext& context, const RouteEntry& entry) {
    std::string settings;
    for (const Property& property : context.value_snapshot->tree->nodes()[entry.node].table->properties()) {
      if (property.kind != PropertyKind::setting) continue;
      const double value = number_of(context, entry, property.name.c_str());
      if (value == property.initial[0]) continue;
      std::string text = number_text(value);
      if (property.type == PropertyType::boolean) text = value != 0 ? "true" : "false";
      if (property.type == PropertyType::choice) text = lua_string(property.choices[static_cast<std::size_t>(value)]);
      settings += fmt::format(", {} = {}", property.name, text);
    }
    return settings;
  }

  void add(GuiContext& context) {
    context.send(is_known(context, name_) ? "/route/connect" : "/route/add",
                 {Arg::of(std::string_view(name_)), Arg::of(std::string_view(from_)), Arg::of(std::string_view(to_))});
    added_ = name_;
  }

  void draw_route(GuiContext& context, const RouteEntry& entry) {
    ImGui::PushID(entry.path.c_str());
    const float close = ImGui::GetFrameHeight();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    property_widget(context, handle_of(context, entry, "enabled"), close);
    ImGui::SameLine(0, gap);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = std::max(ImGui::GetContentRegionAvail().x - close - gap, 8.0F);
    const float height = ImGui::GetFrameHeight() + ImGui::GetTextLineHeight();
    if (ImGui::Selectable("##route", context.selected == entry.path, 0, {width, height})) choose(context, entry);
    context.names.add("route:" + entry.path);
    const std::string source = text_of(context, entry, "from");
    const std::string target = text_of(context, entry, "to");
    const std::string problem = text_of(context, entry, "problem");
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("%s\nFrom %s\nTo %s%s%s", entry.name.c_str(), source.c_str(), target.c_str(),
                        problem.empty() ? "" : "\n", problem.c_str());
    }
    draw_texts(context, entry, from, width, problem.empty() ? ends_text(source, target, width - gap) : problem,
               !problem.empty());
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - close);
    if (icon_button(context.names, ("remove:" + entry.path).c_str(), Icon::close,
                    "Remove the route; its target keeps the last value", false, close))
      context.send("/route/remove", {Arg::of(std::string_view(entry.name))});
    ImGui::PopID();
  }

  // Both addresses, each shortened to its half of the width.
  static std::string ends_text(const std::string& source, const std::string& target, float width) {
    const std::string arrow = " → ";
    const float half = (width - text_width(arrow)) / 2;
    return elided(source, half, text_width) + arrow + elided(target, half, text_width);
  }

  // Draws the name and the values in the first line, and both addresses or the problem in the second.
  static void draw_texts(GuiContext& context, const RouteEntry& entry, ImVec2 at, float width,
                         const std::string& second, bool is_problem) {
    const bool active = number_of(context, entry, "enabled") != 0 && !is_problem;
    const std::string values = is_problem ? "waits"
                                          : fmt::format("{} → {}", number_label(number_of(context, entry, "input")),
                                                        number_label(number_of(context, entry, "output")));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float y = at.y + ImGui::GetStyle().FramePadding.y;
    const float values_width = text_width(values);
    const std::string name = elided(entry.name, width - values_width - 2 * gap, text_width);
    list.AddText({at.x, y}, packed_color(active ? ThemeColor::text : ThemeColor::secondary), name.c_str());
    const ThemeColor tone = is_problem ? ThemeColor::red : active ? ThemeColor::accent : ThemeColor::secondary;
    list.AddText({at.x + width - values_width - gap, y}, packed_color(tone), values.c_str());
    list.AddText({at.x, at.y + ImGui::GetFrameHeight()},
                 packed_color(is_problem ? ThemeColor::red : ThemeColor::secondary),
                 elided(second, width - gap, text_width).c_str());
  }

  void choose(GuiContext& context, const RouteEntry& entry) {
    context.select(entry.path);
    name_ = entry.name;
    from_ = text_of(context, entry, "from");
    to_ = text_of(context, entry, "to");
  }

  std::string name_, from_, to_;  // in the fields
  std::string added_;             // name of a route that was added and is to be selected
};

[[maybe_unused]] const bool kRoutesPanel = register_panel_type<RoutesPanel>({.name = "routes",
                                                                             .title = "Routes",
                                                                             .wide_slot = PanelSlot::bottom_middle,
                                                                             .compact_slot = PanelSlot::bottom,
                                                                             .order = 5});

}  // namespace
}  // namespace limber::panel
