// One function for each kind of row.
#include "gui/property_widget.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "gui/icons.h"
#include "gui/imgui_versions.h"
#include "gui/lua_path.h"
#include "gui/number_bar.h"
#include "gui/theme.h"
#include "params/row_text.h"

namespace limber {

namespace {

constexpr const char* kAxes[] = {"x", "y", "z", "w"};

bool is_color(const Row& row) { return row.type == RowType::vec3 && row.unit == "hsb"; }

BarRange range_of(const Row& row, std::size_t i) {
  return {row.low(i), row.high(i), row.initial[i], row.step, row.type == RowType::integer};
}

std::string axis_name(const PlacedRow& at, std::size_t i) {
  return at.place.row->width > 1 ? fmt::format("{}/{}", at.path, i) : at.path;
}

// numbers of a value that may be set: a bar each, side by side
void numbers(Desk& desk, const PlacedRow& at, HandValues::Values& values, float width) {
  const Row& row = *at.place.row;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x * 0.7F;
  const auto count = static_cast<float>(row.width);
  const float each = (width - gap * (count - 1)) / count;
  bool changed = false;
  bool held = false;
  ImGui::PushFont(desk.fonts.code);
  for (std::size_t i = 0; i < row.width; i++) {
    if (i > 0) ImGui::SameLine(0, gap);
    changed |= number_bar(fmt::format("##{}", i).c_str(), range_of(row, i), each, values[i],
                          row.width == 3 && !is_color(row) ? static_cast<int>(i) : -1);
    held |= ImGui::IsItemActive();
    desk.names.note(axis_name(at, i));
    ImGui::PopFont();
    property_hint(desk, at);
    ImGui::PushFont(desk.fonts.code);
  }
  ImGui::PopFont();
  if (changed) desk.set(at, values, held);
}

void truths(Desk& desk, const PlacedRow& at, HandValues::Values& values) {
  const Row& row = *at.place.row;
  for (std::size_t i = 0; i < row.width; i++) {
    if (i > 0) ImGui::SameLine();
    bool on = values[i] != 0;
    if (ImGui::Checkbox(row.width > 1 ? kAxes[i] : "##on", &on)) {
      values[i] = on ? 1 : 0;
      desk.set(at, values, false);
    }
    desk.names.note(axis_name(at, i));
    property_hint(desk, at);
  }
}

void choice(Desk& desk, const PlacedRow& at, HandValues::Values& values, float width) {
  const Row& row = *at.place.row;
  const auto chosen = static_cast<std::size_t>(std::max(values[0], 0.0));
  ImGui::SetNextItemWidth(width);
  const bool open = ImGui::BeginCombo("##choice", chosen < row.choices.size() ? row.choices[chosen].c_str() : "");
  if (!open) {
    desk.names.note(at.path);
    return property_hint(desk, at);
  }
  for (std::size_t i = 0; i < row.choices.size(); i++) {
    if (ImGui::Selectable(row.choices[i].c_str(), i == chosen)) {
      values[0] = static_cast<double>(i);
      desk.set(at, values, false);
    }
    desk.names.note(fmt::format("{}={}", at.path, row.choices[i]));
  }
  ImGui::EndCombo();
}

// hue, saturation, brightness: a swatch that opens a picker, and its numbers
void color(Desk& desk, const PlacedRow& at, HandValues::Values& values, float width) {
  float hsb[3] = {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
  float rgb[3];
  ImGui::ColorConvertHSVtoRGB(hsb[0], hsb[1], hsb[2], rgb[0], rgb[1], rgb[2]);
  const float height = ImGui::GetFrameHeight();
  const float swatch = height * 1.5F;
  constexpr ImGuiColorEditFlags kPlain = ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop;
  if (ImGui::ColorButton("##swatch", {rgb[0], rgb[1], rgb[2], 1}, kPlain, {swatch, height})) ImGui::OpenPopup("picker");
  desk.names.note("swatch:" + at.path);
  property_hint(desk, at);
  if (ImGui::BeginPopup("picker")) {
    ImGui::SetNextItemWidth(static_cast<float>(220 * desk.scale));
    const bool changed = ImGui::ColorPicker3("##picker", hsb,
                                             kPlain | ImGuiColorEditFlags_InputHSV | ImGuiColorEditFlags_DisplayHSV |
                                                 ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoSidePreview);
    desk.names.note("picker:" + at.path);
    if (changed) {
      for (std::size_t i = 0; i < 3; i++) values[i] = std::clamp(static_cast<double>(hsb[i]), 0.0, 1.0);
      desk.set(at, values, ImGui::IsMouseDown(0));
    }
    ImGui::EndPopup();
  }
  ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
  numbers(desk, at, values, width - swatch - ImGui::GetStyle().ItemInnerSpacing.x);
}

// what is told: words, no frame
void told(Desk& desk, const PlacedRow& at, const HandValues::Values& values, float width) {
  const Row& row = *at.place.row;
  std::string text;
  const bool truth = row.type == RowType::boolean || row.type == RowType::flags3;
  if (row.type == RowType::text) text = desk.text(at.place);
  for (std::size_t i = 0; i < row.width && row.type != RowType::text; i++) {
    const auto label = static_cast<std::size_t>(std::max(values[i], 0.0));
    if (i > 0) text += "  ";
    text += truth ? (values[i] != 0 ? "yes" : "no")
            : row.type == RowType::choice && label < row.choices.size()
                ? row.choices[label]
                : shown_number(values[i], row.type == RowType::integer);
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  const bool fault = row.name == "error" && !text.empty();
  ImGui::PushFont(desk.fonts.code);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, ImGui::GetFrameHeight()});
  desk.names.note(at.path);
  const float y = from.y + ImGui::GetStyle().FramePadding.y;
  ImGui::PushStyleColor(ImGuiCol_Text, packed(fault ? Tone::red : Tone::text));
  imgui::text_ellipsis({from.x, y}, {from.x + width, y + ImGui::GetTextLineHeight()}, text);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  property_hint(desk, at);
}

std::string field_id(std::uint32_t i) { return fmt::format("##arg{}", i); }

// what an action takes is kept as long as its row is shown
void action(Desk& desk, const PlacedRow& at, float width) {
  const Row& row = *at.place.row;
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const auto fields = static_cast<float>(row.min_args);
  const float button = row.min_args == 0 ? width : width * 0.34F;
  if (ImGui::Button(row_words(row).c_str(), {button, 0})) {
    std::vector<Arg> args;
    for (std::uint32_t i = 0; i < row.min_args; i++)
      args.push_back(Arg::of(static_cast<double>(kept.GetFloat(ImGui::GetID(field_id(i).c_str()) + 1))));
    desk.send(at.path, std::move(args));
  }
  desk.names.note(at.path);
  property_hint(desk, at);
  const float each = (width - button - gap * fields) / std::max(fields, 1.0F);
  ImGui::PushFont(desk.fonts.code);
  for (std::uint32_t i = 0; i < row.min_args; i++) {
    ImGui::SameLine(0, gap);
    float* const number = kept.GetFloatRef(ImGui::GetID(field_id(i).c_str()) + 1, 0);
    double value = static_cast<double>(*number);
    const BarRange range{-kUnbounded, kUnbounded, 1, 0, false};
    if (number_bar(field_id(i).c_str(), range, each, value, -1)) *number = static_cast<float>(value);
    desk.names.note(fmt::format("{}/{}", at.path, i));
  }
  ImGui::PopFont();
}

void reset_button(Desk& desk, const PlacedRow& at, float side) {
  const Row& row = *at.place.row;
  if (ImGui::InvisibleButton("##reset", {side, ImGui::GetFrameHeight()})) {
    HandValues::Values initial{};
    std::copy_n(row.initial.begin(), row.width, initial.begin());
    desk.set(at, initial, false);
  }
  desk.names.note("reset:" + at.path);
  const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("back to the default: %s", initial_text(row).c_str());
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(Icon::undo, low.x + side / 2, low.y + ImGui::GetFrameHeight() / 2, ImGui::GetFontSize() * 0.38F,
            packed(hovered ? Tone::accent : Tone::dim));
}

void star_button(Desk& desk, const std::string& path, float side) {
  const bool is = desk.settings.favourites.contains(path);
  if (ImGui::InvisibleButton("##star", {side, ImGui::GetFrameHeight()})) {
    if (is) desk.settings.favourites.erase(path);
    if (!is) desk.settings.favourites.insert(path);
  }
  desk.names.note("star:" + path);
  const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", is ? "no favourite any more" : "a favourite");
  const ImVec2 low = ImGui::GetItemRectMin();
  draw_icon(is ? Icon::star : Icon::star_empty, low.x + side / 2, low.y + ImGui::GetFrameHeight() / 2,
            ImGui::GetFontSize() * 0.4F, packed(is || hovered ? Tone::accent : Tone::dim));
}

void name_text(Desk& desk, const PlacedRow& at, const RowFrame& frame, bool bright, float width) {
  const std::string text = frame.with_path ? at.path : row_words(*at.place.row);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, ImGui::GetFrameHeight()});
  const float y = from.y + ImGui::GetStyle().FramePadding.y;
  ImGui::PushStyleColor(ImGuiCol_Text, packed(bright ? Tone::text : Tone::dim));
  imgui::text_ellipsis({from.x, y}, {from.x + width, y + ImGui::GetTextLineHeight()}, text);
  ImGui::PopStyleColor();
  desk.names.note("name:" + at.path);
  property_hint(desk, at);
}

}  // namespace

std::string row_words(const Row& row) {
  std::string words = row.name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

bool differs_from_default(const Row& row, const HandValues::Values& values) {
  for (std::size_t i = 0; i < row.width; i++) {
    const double a = values[i];
    const double b = row.initial[i];
    if (std::abs(a - b) > 1e-6 * std::max(std::abs(a), std::abs(b))) return true;
  }
  return false;
}

void property_hint(Desk& desk, const PlacedRow& at) {
  const Row& row = *at.place.row;
  if (ImGui::IsItemHovered() && !ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1)) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(row.doc.c_str());
    const std::string values = values_text(row);
    const std::string initial = initial_text(row);
    if (!values.empty() && row.type != RowType::text)
      ImGui::TextDisabled("%s%s%s", values.c_str(), row.unit.empty() ? "" : "  ", row.unit.c_str());
    if (!initial.empty() && row.kind == RowKind::property) ImGui::TextDisabled("default %s", initial.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, packed(Tone::accent));
    ImGui::TextUnformatted(at.path.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  if (!ImGui::BeginPopupContextItem("##copy")) return;
  if (ImGui::Selectable("copy the OSC address")) desk.copied(at.path);
  desk.names.note("copy_address");
  const std::string lua = lua_path(*desk.image->tree, at.place);
  if (!lua.empty() && ImGui::Selectable("copy the Lua path")) desk.copied(lua);
  if (!lua.empty()) desk.names.note("copy_lua");
  const bool plotted = std::find(desk.plots.begin(), desk.plots.end(), at.path) != desk.plots.end();
  if (!plotted && row.width > 0 && row.type != RowType::text && ImGui::Selectable("plot it"))
    desk.plots.push_back(at.path);
  desk.names.note("plot_it");
  ImGui::EndPopup();
}

void property_widget(Desk& desk, const PlacedRow& at, float width) {
  const Row& row = *at.place.row;
  if (row.kind == RowKind::action) return action(desk, at, width);
  HandValues::Values values{};
  desk.values(at, values);
  if (!row.writable()) return told(desk, at, values, width);
  if (row.type == RowType::boolean || row.type == RowType::flags3) return truths(desk, at, values);
  if (row.type == RowType::choice) return choice(desk, at, values, width);
  if (is_color(row)) return color(desk, at, values, width);
  numbers(desk, at, values, width);
}

void property_row(Desk& desk, const PlacedRow& at, const RowFrame& frame) {
  const Row& row = *at.place.row;
  const float height = ImGui::GetFrameHeight();
  const float whole = ImGui::GetContentRegionAvail().x;
  const bool below = frame.with_path;
  const float lines = below ? 2 * height + ImGui::GetStyle().ItemSpacing.y : height;
  if (!ImGui::IsRectVisible({whole, lines}) && !ImGui::IsAnyItemActive()) return ImGui::Dummy({whole, lines});
  ImGui::PushID(at.path.c_str());
  const float side = height * 0.86F;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  HandValues::Values values{};
  const bool set = desk.values(at, values) && row.kind == RowKind::property && differs_from_default(row, values);
  if (frame.star) {
    star_button(desk, at.path, side);
    ImGui::SameLine(0, gap * 0.5F);
  }
  const float left = frame.star ? side + gap * 0.5F : 0;
  const float name = below ? whole - left : static_cast<float>(frame.name_part) * whole - left;
  name_text(desk, at, frame, set || !row.writable(), name - gap);
  if (!below) ImGui::SameLine(left + name + ImGui::GetCursorStartPos().x);
  if (below) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + left);
  const bool unit = !row.unit.empty() && row.unit != "hsb" && row.unit.size() <= 8 && row.kind != RowKind::action;
  const float units = unit ? ImGui::GetFontSize() * 2.3F : 0;
  property_widget(desk, at, whole - left - (below ? 0 : name) - side - gap - units);
  if (unit) {
    ImGui::SameLine(whole - side - gap - units + gap * 0.7F + ImGui::GetCursorStartPos().x);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", row.unit.c_str());
  }
  if (set) {
    ImGui::SameLine(whole - side + ImGui::GetCursorStartPos().x);
    reset_button(desk, at, side);
  }
  ImGui::PopID();
}

}  // namespace limber
