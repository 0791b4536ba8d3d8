// One function for each type of property.
#include "ui/panel/widgets/property_widget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "base/text.h"
#include "properties/property_text.h"
#include "ui/panel/imgui_versions.h"
#include "ui/panel/lua_path.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"

namespace limber::panel {

namespace {

constexpr const char* kAxes[] = {"x", "y", "z", "w"};
constexpr const char* kMenu = "##menu";  // id of the context menu in the scope of the property

bool is_color(const Property& property) { return property.type == PropertyType::vec3 && property.unit == "hsb"; }

SliderRange range_of(const Property& property, std::size_t i) {
  return {property.low(i), property.high(i), property.initial[i], property.step,
          property.type == PropertyType::integer};
}

std::string axis_name(const PropertyHandle& handle, std::size_t i) {
  return handle.ref.property->width > 1 ? fmt::format("{}/{}", handle.path, i) : handle.path;
}

// Writable numbers: one bar for each, side by side.
void numbers(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width) {
  const Property& property = *handle.ref.property;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x * 0.7F;
  const auto count = static_cast<float>(property.width);
  const float each = (width - gap * (count - 1)) / count;
  bool changed = false;
  bool dragging = false;
  ImGui::PushFont(context.fonts.code);
  for (std::size_t i = 0; i < property.width; i++) {
    if (i > 0) ImGui::SameLine(0, gap);
    changed |= number_slider(fmt::format("##{}", i).c_str(), range_of(property, i), each, values[i],
                             property.width == 3 && !is_color(property) ? static_cast<int>(i) : -1);
    dragging |= ImGui::IsItemActive();
    context.names.add(axis_name(handle, i));
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
    context.names.add(axis_name(handle, i));
    property_hint(handle);
  }
}

void choice(GuiContext& context, const PropertyHandle& handle, PendingValues::Values& values, float width) {
  const Property& property = *handle.ref.property;
  const auto selected = static_cast<std::size_t>(std::max(values[0], 0.0));
  ImGui::SetNextItemWidth(width);
  const bool open =
      ImGui::BeginCombo("##choice", selected < property.choices.size() ? property.choices[selected].c_str() : "");
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
  const float swatch = height * 1.5F;
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

// A read-only value as plain text.
void readout_text(GuiContext& context, const PropertyHandle& handle, const PendingValues::Values& values, float width) {
  const Property& property = *handle.ref.property;
  std::string text;
  const bool is_boolean = property.type == PropertyType::boolean || property.type == PropertyType::flags3;
  if (property.type == PropertyType::text) text = context.text(handle.ref);
  for (std::size_t i = 0; i < property.width && property.type != PropertyType::text; i++) {
    const auto label = static_cast<std::size_t>(std::max(values[i], 0.0));
    if (i > 0) text += "  ";
    text += is_boolean ? (values[i] != 0 ? "yes" : "no")
            : property.type == PropertyType::choice && label < property.choices.size()
                ? property.choices[label]
                : number_label(values[i], property.type == PropertyType::integer);
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  const bool is_error = property.name == "error" && !text.empty();
  ImGui::PushFont(context.fonts.code);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, ImGui::GetFrameHeight()});
  context.names.add(handle.path);
  const float y = from.y + ImGui::GetStyle().FramePadding.y;
  ImGui::PushStyleColor(ImGuiCol_Text, packed_color(is_error ? ThemeColor::red : ThemeColor::text));
  imgui::text_ellipsis({from.x, y}, {from.x + width, y + ImGui::GetTextLineHeight()}, text);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  property_hint(handle);
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
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const auto fields = static_cast<float>(property.min_args);
  const float button = property.min_args == 0 ? width : width * 0.34F;
  if (ImGui::Button(property_label(property).c_str(), {button, 0})) {
    std::vector<Arg> args;
    for (std::uint32_t i = 0; i < property.min_args; i++)
      args.push_back(Arg::of(static_cast<double>(storage.GetFloat(ImGui::GetID(field_id(i).c_str()) + 1))));
    invoke(context, handle, {handle.path, std::move(args)});
  }
  context.names.add(handle.path);
  property_hint(handle);
  const float each = (width - button - gap * fields) / std::max(fields, 1.0F);
  ImGui::PushFont(context.fonts.code);
  for (std::uint32_t i = 0; i < property.min_args; i++) {
    ImGui::SameLine(0, gap);
    float* const number = storage.GetFloatRef(ImGui::GetID(field_id(i).c_str()) + 1, 0);
    double value = static_cast<double>(*number);
    const SliderRange range{-kUnbounded, kUnbounded, 1, 0, false};
    if (number_slider(field_id(i).c_str(), range, each, value, -1)) *number = static_cast<float>(value);
    context.names.add(fmt::format("{}/{}", handle.path, i));
  }
  ImGui::PopFont();
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

void name_text(GuiContext& context, const PropertyHandle& handle, const PropertyLineOptions& options, bool bright,
               float width) {
  const std::string text = options.with_path ? handle.path : property_label(*handle.ref.property);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, ImGui::GetFrameHeight()});
  const float y = from.y + ImGui::GetStyle().FramePadding.y;
  ImGui::PushStyleColor(ImGuiCol_Text, packed_color(bright ? ThemeColor::text : ThemeColor::secondary));
  imgui::text_ellipsis({from.x, y}, {from.x + width, y + ImGui::GetTextLineHeight()}, text);
  ImGui::PopStyleColor();
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

// True if the unit is shown beside the widget.
bool shows_unit(const Property& property) {
  return !property.unit.empty() && property.unit != "hsb" && property.unit.size() <= 8 &&
         property.kind != PropertyKind::action;
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
  const float height = ImGui::GetFrameHeight();
  const float width = ImGui::GetContentRegionAvail().x;
  const bool below = options.with_path;
  const float lines = below ? 2 * height + ImGui::GetStyle().ItemSpacing.y : height;
  if (!ImGui::IsRectVisible({width, lines}) && !ImGui::IsAnyItemActive()) return ImGui::Dummy({width, lines});
  ImGui::PushID(handle.path.c_str());
  const float side = height * 0.86F;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  PendingValues::Values values{};
  const bool differs = context.values(handle, values) && property.kind == PropertyKind::setting &&
                       differs_from_default(property, values);
  if (options.star) {
    star_button(context, handle.path, side);
    ImGui::SameLine(0, gap * 0.5F);
  }
  const float left = options.star ? side + gap * 0.5F : 0;
  const float name = below ? width - left : static_cast<float>(options.name_fraction) * width - left;
  name_text(context, handle, options, differs || !property.writable(), name - gap);
  if (below) {
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + left);
  } else {
    ImGui::SameLine(left + name + ImGui::GetCursorStartPos().x);
  }
  const bool unit = shows_unit(property);
  const float units = unit ? ImGui::GetFontSize() * 2.3F : 0;
  property_widget(context, handle, width - left - (below ? 0 : name) - side - gap - units);
  if (unit) {
    ImGui::SameLine(width - side - gap - units + gap * 0.7F + ImGui::GetCursorStartPos().x);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", property.unit.c_str());
  }
  if (differs) {
    ImGui::SameLine(width - side + ImGui::GetCursorStartPos().x);
    reset_button(context, handle, side);
  }
  property_menu(context, handle);
  ImGui::PopID();
}

}  // namespace limber::panel
