// One function for each type of property.
#include "ui/panel/widgets/property_widget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "base/text.h"
#include "properties/property_text.h"
#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/lua_path.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/euler_fields.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/line_layout.h"
#include "ui/panel/widgets/number_fields.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

constexpr const char* kAxes[] = {"x", "y", "z", "w"};
constexpr const char* kMenu = "##menu";  // id of the context menu in the scope of the property

// Writable numbers: one bar for each, side by side if there is room.
void numbers(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width) {
  const Property& property = *handle.ref.property;
  const FieldGrid grid = field_grid(property, width, context.fonts.code);
  const float left = ImGui::GetCursorPosX();
  bool changed = false;
  bool dragging = false;
  ImGui::PushFont(context.fonts.code);
  for (std::size_t i = 0; i < property.width; i++) {
    next_field(i, grid, left);
    changed |= number_slider(fmt::format("##{}", i).c_str(), range_of(property, i), grid.each, values[i],
                             property.width == 3 && !is_color(property) ? static_cast<int>(i) : -1,
                             zero_below(property, i, values));
    dragging |= ImGui::IsItemActive();
    context.names.add(component_name(handle, i));
    ImGui::PopFont();
    property_hint(handle);
    ImGui::PushFont(context.fonts.code);
  }
  ImGui::PopFont();
  if (changed) context.set(handle, values, dragging);
}

void checkboxes(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values) {
  const Property& property = *handle.ref.property;
  for (std::size_t i = 0; i < property.width; i++) {
    if (i > 0) ImGui::SameLine();
    bool on = values[i] != 0;
    if (ImGui::Checkbox(property.width > 1 ? kAxes[i] : "##on", &on)) {
      values[i] = on ? 1 : 0;
      context.set(handle, values, false);
    }
    context.names.add(component_name(handle, i));
    property_hint(handle);
  }
}

void choice(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width) {
  const Property& property = *handle.ref.property;
  const auto selected = static_cast<std::size_t>(std::max(values[0], 0.0));
  ImGui::SetNextItemWidth(width);
  const float space = width - ImGui::GetFrameHeight() - 2 * ImGui::GetStyle().FramePadding.x;
  const bool open = ImGui::BeginCombo("##choice", selected < property.choices.size()
                                                      ? elided(property.choices[selected], space, text_width).c_str()
                                                      : "");
  if (!open) {
    context.names.add(handle.path);
    return property_hint(handle);
  }
  for (std::size_t i = 0; i < property.choices.size(); i++) {
    if (ImGui::Selectable(property.choices[i].c_str(), i == selected)) {
      values[0] = static_cast<double>(i);
      context.set(handle, values, false);
    }
    context.names.add(fmt::format("{}={}", handle.path, property.choices[i]));
  }
  ImGui::EndCombo();
}

// A color as hue, saturation, brightness: a swatch that opens a picker, and its numbers.
void color(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width) {
  float hsb[3] = {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
  float rgb[3];
  ImGui::ColorConvertHSVtoRGB(hsb[0], hsb[1], hsb[2], rgb[0], rgb[1], rgb[2]);
  const float height = ImGui::GetFrameHeight();
  const float swatch = swatch_width() - ImGui::GetStyle().ItemInnerSpacing.x;
  constexpr ImGuiColorEditFlags kPlain = ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop;
  if (ImGui::ColorButton("##swatch", {rgb[0], rgb[1], rgb[2], 1}, kPlain, {swatch, height})) ImGui::OpenPopup("picker");
  context.names.add("swatch:" + handle.path);
  property_hint(handle);
  if (ImGui::BeginPopup("picker")) {
    ImGui::SetNextItemWidth(static_cast<float>(220 * context.scale));
    const bool changed = ImGui::ColorPicker3("##picker", hsb,
                                             kPlain | ImGuiColorEditFlags_InputHSV | ImGuiColorEditFlags_DisplayHSV |
                                                 ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoSidePreview);
    context.names.add("picker:" + handle.path);
    if (changed) {
      for (std::size_t i = 0; i < 3; i++) values[i] = std::clamp(static_cast<double>(hsb[i]), 0.0, 1.0);
      context.set(handle, values, ImGui::IsMouseDown(0));
    }
    ImGui::EndPopup();
  }
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  numbers(context, handle, values, width - swatch - ImGui::GetStyle().ItemInnerSpacing.x);
}

// The text of a read-only value that is no number.
std::string readout_label(GuiContext& context, const PropertyHandle& handle, double value) {
  const Property& property = *handle.ref.property;
  if (property.type == PropertyType::text) {
    std::string text(context.text(handle.ref));
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }
  if (property.type == PropertyType::boolean || property.type == PropertyType::flags3) return value != 0 ? "yes" : "no";
  const auto label = static_cast<std::size_t>(std::max(value, 0.0));
  return label < property.choices.size() ? property.choices[label] : number_label(value, {.integer = true});
}

// A read-only value as plain text, in the places of fields.
void readout_text(GuiContext& context, const PropertyHandle& handle, const PendingValues::Values& values, float width) {
  const Property& property = *handle.ref.property;
  const bool numeric = is_numeric(property);
  const FieldGrid grid =
      numeric ? field_grid(property, width, context.fonts.code) : field_grid(std::max(property.width, 1u), width, 0);
  const float left = ImGui::GetCursorPosX();
  const bool is_error = property.name == "error" && !context.text(handle.ref).empty();
  for (std::size_t i = 0; i < std::max(property.width, 1u); i++) {
    next_field(i, grid, left);
    ImGui::PushFont(context.fonts.code);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    ImGui::Dummy({grid.each, height});
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(is_error ? ThemeColor::red : ThemeColor::text));
    if (numeric) {
      draw_number(values[i], {zero_below(property, i, values), property.type == PropertyType::integer},
                  {from.x, from.y, grid.each, height});
    } else {
      const std::string label = readout_label(context, handle, values[i]);
      const std::string text = elided(label, grid.each, text_width);
      if (text != label && ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
        ImGui::TextUnformatted(label.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
      }
      const bool centered = property.type != PropertyType::text;
      const float x = centered ? std::floor(from.x + (grid.each - text_width(text)) / 2) : from.x;
      ImGui::GetWindowDrawList()->AddText({x, from.y + ImGui::GetStyle().FramePadding.y},
                                          ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    }
    ImGui::PopStyleColor();
    ImGui::PopFont();
    context.names.add(component_name(handle, i));
    property_hint(handle);
  }
}

std::string field_id(std::uint32_t i) { return fmt::format("##arg{}", i); }

// Sends the message of an action. A removal can't be undone, so the user is asked before.
void invoke(GuiContext& context, const PropertyHandle& handle, Message message) {
  if (handle.ref.property->name != "remove") {
    context.send(std::move(message));
    return;
  }
  const TreeSnapshot& tree = *context.value_snapshot->tree;
  const std::string object = handle.path.substr(0, handle.path.find_last_of('/'));
  const std::string which = is_pattern(object) ? fmt::format("every object that matches {}", object)
                                               : fmt::format("{} '{}'", tree.nodes()[handle.ref.node].table->name(),
                                                             tree.name(handle.ref.node));
  context.requests.confirmation = {
      fmt::format("Remove {}? This can't be undone; a reset restores the objects of the scene.", which), "Remove",
      std::move(message)};
}

// The arguments of an action are stored while its line is visible.
void action(GuiContext& context, const PropertyHandle& handle, float width) {
  const Property& property = *handle.ref.property;
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ActionLayout layout = action_layout(context, property, width);
  const float left = ImGui::GetCursorPosX();
  const std::string label =
      elided(property_label(property), layout.button - 2 * ImGui::GetStyle().FramePadding.x + 1, text_width);
  if (ImGui::Button(fmt::format("{}###act", label).c_str(), {layout.button, 0})) {
    std::vector<Arg> args;
    for (std::uint32_t i = 0; i < property.min_args; i++)
      args.push_back(Arg::of(static_cast<double>(storage.GetFloat(ImGui::GetID(field_id(i).c_str()) + 1))));
    invoke(context, handle, {handle.path, std::move(args)});
  }
  context.names.add(handle.path);
  property_hint(handle);
  for (std::uint32_t i = 0; i < property.min_args; i++) {
    if (i == 0 && !layout.below) {
      ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    } else if (i == 0) {
      ImGui::SetCursorPosX(left);
    } else {
      next_field(i, layout.fields, left);
    }
    float* const number = storage.GetFloatRef(ImGui::GetID(field_id(i).c_str()) + 1, 0);
    double value = static_cast<double>(*number);
    ImGui::PushFont(context.fonts.code);
    if (number_slider(field_id(i).c_str(), kArgument, layout.fields.each, value)) *number = static_cast<float>(value);
    ImGui::PopFont();
    context.names.add(fmt::format("{}/{}", handle.path, i));
    property_hint(handle);
  }
}

void reset_button(GuiContext& context, const PropertyHandle& handle, float side) {
  const Property& property = *handle.ref.property;
  if (ImGui::InvisibleButton("##reset", {side, ImGui::GetFrameHeight()})) {
    PendingValues::Values initial{};
    std::copy_n(property.initial.begin(), property.width, initial.begin());
    context.set(handle, initial, false);
  }
  context.names.add("reset:" + handle.path);
  const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Reset to the default: %s", initial_text(property).c_str());
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(Icon::undo, low.x + side / 2, low.y + ImGui::GetFrameHeight() / 2, ImGui::GetFontSize() * 0.38F,
            packed_color(hovered ? ThemeColor::accent : ThemeColor::secondary));
}

void star_button(GuiContext& context, const std::string& path, float side) {
  const bool starred = context.settings.favorites.contains(path);
  if (ImGui::InvisibleButton("##star", {side, ImGui::GetFrameHeight()})) {
    if (starred) context.settings.favorites.erase(path);
    if (!starred) context.settings.favorites.insert(path);
  }
  context.names.add("star:" + path);
  const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", starred ? "Remove from favorites" : "Add to favorites");
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(starred ? Icon::star : Icon::star_empty, low.x + side / 2, low.y + ImGui::GetFrameHeight() / 2,
            ImGui::GetFontSize() * 0.4F, packed_color(starred || hovered ? ThemeColor::accent : ThemeColor::secondary));
}

// Draws the lines of the name, and the unit after the last one if it isn't beside the widget.
void name_text(GuiContext& context, const PropertyHandle& handle, const LineLayout& layout, bool bright) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  ImGui::Dummy({layout.name_width, layout.name_height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float y = from.y + ImGui::GetStyle().FramePadding.y;
  for (const std::string& text : layout.name) {
    list.AddText({from.x, y}, packed_color(bright ? ThemeColor::text : ThemeColor::secondary), text.c_str());
    y += line;
  }
  if (layout.above && !layout.unit.empty()) {
    const float x = from.x + text_width(layout.name.back()) + ImGui::GetFontSize() * 0.6F;
    list.AddText({x, y - line}, packed_color(ThemeColor::secondary), layout.unit.c_str());
  }
  context.names.add("name:" + handle.path);
  property_hint(handle);
}

void property_tooltip(const PropertyHandle& handle) {
  const Property& property = *handle.ref.property;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  ImGui::TextUnformatted(property.doc.c_str());
  const std::string values = range_or_choices_text(property);
  const std::string initial = initial_text(property);
  if (!values.empty() && property.type != PropertyType::text)
    ImGui::TextDisabled("%s%s%s", values.c_str(), property.unit.empty() ? "" : "  ", property.unit.c_str());
  if (!initial.empty() && property.kind == PropertyKind::setting) ImGui::TextDisabled("Default %s", initial.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, packed_color(ThemeColor::accent));
  ImGui::TextUnformatted(handle.path.c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

// Returns the layout of a line, or skips it if it is outside the visible area. The heights of skipped lines are those
// of the last time.
std::optional<LineLayout> visible_layout(const GuiContext& context, const PropertyHandle& handle,
                                         const PropertyLineOptions& options, float width) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID key = ImGui::GetID(handle.path.c_str());
  const float mode = width + (options.with_path ? 0.5F : 0);
  const auto skip = [&](float height) {
    if (ImGui::IsRectVisible({width, height}) || ImGui::IsAnyItemActive()) return false;
    ImGui::Dummy({width, height});
    return true;
  };
  if (storage.GetFloat(key + 1) == mode && skip(storage.GetFloat(key))) return std::nullopt;
  LineLayout layout = line_layout(context, handle, options, width);
  storage.SetFloat(key, layout.height);
  storage.SetFloat(key + 1, mode);
  if (skip(layout.height)) return std::nullopt;
  return layout;
}

}  // namespace

std::string property_label(const Property& property) {
  std::string label = property.name;
  std::replace(label.begin(), label.end(), '_', ' ');
  if (!label.empty() && label[0] >= 'a' && label[0] <= 'z') label[0] = static_cast<char>(label[0] - 'a' + 'A');
  return label;
}

bool differs_from_default(const Property& property, const PendingValues::Values& values) {
  for (std::size_t i = 0; i < property.width; i++) {
    const double a = values[i];
    const double b = property.initial[i];
    if (std::abs(a - b) > 1e-6 * std::max(std::abs(a), std::abs(b))) return true;
  }
  return false;
}

void property_hint(const PropertyHandle& handle) {
  if (ImGui::IsItemHovered() && !ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1)) property_tooltip(handle);
  ImGui::OpenPopupOnItemClick(kMenu, ImGuiPopupFlags_MouseButtonRight);
}

namespace {

// Offers the property as an end of a route.
void route_menu(GuiContext& context, const PropertyHandle& handle) {
  const Property& property = *handle.ref.property;
  if (property.width == 0 || property.type == PropertyType::text) return;
  if (ImGui::Selectable("Route from here")) context.requests.route_from = handle.path;
  context.names.add("menu:route_from");
  if (!property.writable()) return;
  if (ImGui::Selectable("Route to here")) context.requests.route_to = handle.path;
  context.names.add("menu:route_to");
}

// Offers to set the property, or each of its numbers, by a MIDI control.
void midi_menu(GuiContext& context, const PropertyHandle& handle) {
  const Property& property = *handle.ref.property;
  const bool is_action = property.kind == PropertyKind::action;
  if (!context.link.midi.available() || !(property.writable() || is_action)) return;
  constexpr std::array kAxes = {"x", "y", "z", "w"};
  const std::size_t count = std::max<std::size_t>(property.width, 1);
  for (std::size_t i = 0; i < count; i++) {
    const std::string label = count == 1 ? "MIDI learn" : fmt::format("MIDI learn {}", kAxes[i]);
    std::vector<Arg> args = {Arg::of(std::string_view(handle.path))};
    if (count > 1) args.push_back(Arg::of(static_cast<double>(i + 1)));
    if (ImGui::Selectable(label.c_str())) {
      context.send("/midi/learn", std::move(args));
      context.show_notice("Move the control for " + handle.path);
    }
    context.names.add(count == 1 ? "menu:midi_learn" : fmt::format("menu:midi_learn_{}", kAxes[i]));
  }
}

}  // namespace

void property_menu(GuiContext& context, const PropertyHandle& handle) {
  const Property& property = *handle.ref.property;
  if (!ImGui::BeginPopup(kMenu)) return;
  if (ImGui::Selectable("Copy OSC address")) context.copy_with_notice(handle.path);
  context.names.add("menu:copy_address");
  if (const std::string lua = lua_path(*context.value_snapshot->tree, handle.ref); !lua.empty()) {
    if (ImGui::Selectable("Copy Lua path")) context.copy_with_notice(lua);
    context.names.add("menu:copy_lua");
  }
  const bool plotted = std::find(context.plots.begin(), context.plots.end(), handle.path) != context.plots.end();
  if (!plotted && property.width > 0 && property.type != PropertyType::text) {
    if (ImGui::Selectable("Plot")) context.plots.push_back(handle.path);
    context.names.add("menu:plot");
  }
  route_menu(context, handle);
  midi_menu(context, handle);
  ImGui::EndPopup();
}

void property_widget(GuiContext& context, const PropertyHandle& handle, float width) {
  const Property& property = *handle.ref.property;
  if (property.kind == PropertyKind::action) return action(context, handle, width);
  PendingValues::Values values{};
  context.values(handle, values);
  if (!property.writable()) return readout_text(context, handle, values, width);
  if (property.type == PropertyType::boolean || property.type == PropertyType::flags3)
    return checkboxes(context, handle, values);
  if (property.type == PropertyType::choice) return choice(context, handle, values, width);
  if (is_color(property)) return color(context, handle, values, width);
  numbers(context, handle, values, width);
}

void property_line(GuiContext& context, const PropertyHandle& handle, const PropertyLineOptions& options) {
  const Property& property = *handle.ref.property;
  const float width = ImGui::GetContentRegionAvail().x;
  const std::optional<LineLayout> shown = visible_layout(context, handle, options, width);
  if (!shown) return;
  const LineLayout& layout = *shown;
  ImGui::PushID(handle.path.c_str());
  const float start = ImGui::GetCursorStartPos().x;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  PendingValues::Values values{};
  const bool differs = context.values(handle, values) && property.kind == PropertyKind::setting &&
                       differs_from_default(property, values);
  if (options.star) {
    star_button(context, handle.path, reset_width());
    ImGui::SameLine(0, gap * 0.5F);
  }
  if (!layout.name.empty()) name_text(context, handle, layout, differs || !property.writable());
  if (layout.above) {
    ImGui::SetCursorPos({start + layout.left, ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y + kNameSpacing});
  } else if (!layout.name.empty()) {
    ImGui::SameLine(start + layout.left + layout.name_width + gap);
  }
  const float widget_x = ImGui::GetCursorPosX();
  property_widget(context, handle, layout.widget_width);
  if (!layout.above && !layout.unit.empty()) {
    ImGui::SameLine(widget_x + layout.widget_width + gap * 0.7F);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", layout.unit.c_str());
  }
  if (differs) {
    ImGui::SameLine(start + width - reset_width());
    reset_button(context, handle, reset_width());
  }
  if (property.type == PropertyType::quat) {
    ImGui::SetCursorPosX(widget_x);
    euler_fields(context, handle, values, layout.widget_width);
  }
  property_menu(context, handle);
  ImGui::PopID();
}

}  // namespace limber::panel
