// Compares the widths of texts and fields with the width of the line.
#include "ui/panel/widgets/line_layout.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "ui/panel/imgui/imgui_versions.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/widgets/euler_fields.h"

namespace limber::panel {

namespace {

constexpr float kUnitColumn = 2.3F;  // width of the column of units, in units of the font size

// The unit that is shown: none for colors and actions.
std::string shown_unit(const Property& property) {
  return property.unit == "hsb" || property.kind == PropertyKind::action ? std::string() : property.unit;
}

float number_row_height(const GuiContext& context) {
  return imgui::font_height(*context.fonts.code) + 2 * ImGui::GetStyle().FramePadding.y;
}

// The height of property_widget().
float widget_height(const GuiContext& context, const Property& property, float width) {
  const float spacing = ImGui::GetStyle().ItemSpacing.y;
  const float row = number_row_height(context);
  const auto rows_height = [&](std::size_t rows) { return static_cast<float>(rows) * (row + spacing) - spacing; };
  if (property.kind == PropertyKind::action) {
    const ActionLayout layout = action_layout(context, property, width);
    if (property.min_args == 0) return ImGui::GetFrameHeight();
    return layout.below ? ImGui::GetFrameHeight() + spacing + rows_height(layout.fields.rows) : row;
  }
  if (!is_numeric(property)) return property.writable() ? ImGui::GetFrameHeight() : row;
  const float numbers_width = is_color(property) ? width - swatch_width() : width;
  return rows_height(field_grid(property, numbers_width, context.fonts.code).rows);
}

// True if the numbers fit in one row.
bool fits_in_row(const GuiContext& context, const Property& property, float width) {
  if (!is_numeric(property)) return true;
  const float numbers_width = is_color(property) ? width - swatch_width() : width;
  return field_grid(property, numbers_width, context.fonts.code).rows == 1;
}

}  // namespace

bool is_color(const Property& property) { return property.type == PropertyType::vec3 && property.unit == "hsb"; }

bool is_numeric(const Property& property) {
  return property.type == PropertyType::number || property.type == PropertyType::integer ||
         property.type == PropertyType::vec3 || property.type == PropertyType::quat;
}

// The width of a color's swatch and the gap beside it.
float swatch_width() { return ImGui::GetFrameHeight() * 1.5F + ImGui::GetStyle().ItemInnerSpacing.x; }

// The width of the buttons at the ends of a line.
float reset_width() { return ImGui::GetFrameHeight() * 0.86F; }

ActionLayout action_layout(const GuiContext& context, const Property& property, float width) {
  ActionLayout layout;
  if (property.min_args == 0) return {width, false, {}};
  ImGui::PushFont(context.fonts.code);
  const float field = min_number_width(kArgument);
  ImGui::PopFont();
  const float label = text_width(property_label(property)) + 2 * ImGui::GetStyle().FramePadding.x;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  layout.button = std::min(std::max(label, width * 0.36F), width);
  layout.fields = field_grid(property.min_args, width - layout.button - gap, field);
  layout.below = layout.fields.rows > 1 || layout.fields.each < field;
  if (layout.below) layout.fields = field_grid(property.min_args, width, field);
  return layout;
}

LineLayout line_layout(const GuiContext& context, const PropertyHandle& handle, const PropertyLineOptions& options,
                       float width) {
  const Property& property = *handle.ref.property;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float side = reset_width();
  LineLayout layout;
  layout.left = options.star ? side + gap * 0.5F : 0;
  layout.unit = shown_unit(property);
  const float rest = width - layout.left - side - gap;
  const std::string name = options.with_path ? handle.path : property_label(property);
  if (property.kind == PropertyKind::action && !options.with_path) {
    layout.widget_width = rest;
    layout.height = widget_height(context, property, rest);
    return layout;
  }
  const float unit = layout.unit.empty() ? 0 : text_width(layout.unit) + gap;
  layout.name_width = static_cast<float>(options.name_fraction) * width - layout.left - gap;
  layout.unit_width = std::floor(ImGui::GetFontSize() * kUnitColumn);
  layout.widget_width = rest - layout.name_width - gap - layout.unit_width;
  layout.above = options.with_path || text_width(name) > layout.name_width || unit > layout.unit_width ||
                 property.type == PropertyType::quat || property.type == PropertyType::text ||
                 !fits_in_row(context, property, layout.widget_width);
  layout.name_height = ImGui::GetFrameHeight();
  if (layout.above) {
    layout.name_width = width - layout.left - gap;
    layout.unit_width = 0;
    layout.widget_width = rest;
    layout.name = wrapped(name, layout.name_width - unit - gap, text_width);
    const float lines = static_cast<float>(layout.name.size()) * ImGui::GetTextLineHeight();
    layout.name_height = std::max(layout.name_height, lines + ImGui::GetStyle().FramePadding.y);
  } else {
    layout.name = {name};
  }
  const float widget = widget_height(context, property, layout.widget_width);
  layout.height = layout.above ? layout.name_height + kNameSpacing + widget : std::max(layout.name_height, widget);
  if (property.type == PropertyType::quat)
    layout.height += ImGui::GetStyle().ItemSpacing.y + euler_height(context, layout.widget_width);
  return layout;
}

}  // namespace limber::panel
