// Parameters: the properties of the selected object, the scene, the world and the view; search and favorites.
#include <array>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_search.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel {

namespace {

struct TopSection {
  const char* path;
  const char* title;
  bool open;
};
constexpr std::array kTopSections = {
    TopSection{"/scene", "Scene", true},
    TopSection{"/physics/sim", "World", true},
    TopSection{"/visuals/look", "Appearance", true},
    TopSection{"/visuals", "Background", false},
    TopSection{"/visuals/camera", "Camera", false},
};

class ParametersPanel : public Panel {
 public:
  void update(GuiContext& context) override {
    if (context.value_snapshot == nullptr) return;
    search_.start(words_);
    search_.advance(context.value_snapshot->tree);
  }

  void draw(GuiContext& context) override {
    const float side = ImGui::GetFrameHeight() * 1.15F;
    if (std::exchange(context.requests.focus_search, false)) {
      ImGui::SetWindowFocus();  // Dear ImGui 1.90.1 focuses items of the focused window only
      ImGui::SetKeyboardFocusHere();
    }
    search_field(context.names, "parameters.search", "Search (Ctrl+F)", words_,
                 ImGui::GetContentRegionAvail().x - side - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SameLine();
    if (icon_button(context.names, "parameters.favorites", Icon::star, "Favorites only", favorites_only_, side))
      favorites_only_ = !favorites_only_;
    if (!ImGui::BeginChild("##properties", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    if (search_.active()) {
      show_found(context);
    } else if (favorites_only_) {
      show_favorites(context);
    } else {
      if (!context.selected.empty()) show_selected(context);
      for (const TopSection& section : kTopSections) {
        if (context.selected != section.path) show_object(context, section.path, section.title, section.open);
      }
    }
    ImGui::EndChild();
  }

 private:
  void show_found(GuiContext& context) {
    for (const PropertyHandle& handle : search_.found()) {
      if (favorites_only_ && !context.settings.favorites.contains(handle.path)) continue;
      property_line(context, handle, {.star = true, .with_path = true});
    }
    if (search_.done() && search_.found().empty()) ImGui::TextDisabled("No results");
    if (search_.more()) ImGui::TextDisabled("There are more results; add a word");
    if (!search_.done()) ImGui::TextDisabled("Searching…");
  }

  void show_favorites(GuiContext& context) {
    // a copy, because a star may be removed during iteration
    const std::set<std::string> paths = context.settings.favorites;
    for (const std::string& path : paths) {
      if (const auto handle = context.find(path)) property_line(context, *handle, {.star = true, .with_path = true});
    }
    if (paths.empty()) ImGui::TextDisabled("Click the star of a property to add it");
  }

  // Shows the properties of the selected object. A pattern shows its first match, and setting a value sets all matches.
  static void show_selected(GuiContext& context) {
    PatternBudget budget;
    const std::string path = context.selected;
    std::uint32_t node = 0;
    std::size_t count = 1;
    if (path.find('*') == std::string::npos) {
      const Result<TreePropertyRef> ref = context.value_snapshot->tree->find(path);
      if (ref && ref->property == nullptr) node = ref->node;
    } else if (const auto matches = context.value_snapshot->tree->match(path + "/active", budget, 100000);
               matches && !matches->empty()) {
      node = matches->front().node;
      count = matches->size();
    }
    if (node == 0) {
      context.selected.clear();  // the object was removed
      return;
    }
    const std::string_view name = context.value_snapshot->tree->name(node);
    const std::string title = count > 1 ? fmt::format("{}  \u00d7{}", name, count) : std::string(name);
    if (header(context, path, title, true)) draw_properties(context, node, path);
  }

  static void show_object(GuiContext& context, const char* path, const char* title, bool open) {
    const Result<TreePropertyRef> ref = context.value_snapshot->tree->find(path);
    if (!ref || ref->property != nullptr ||
        context.value_snapshot->tree->nodes()[ref->node].table->properties().empty())
      return;
    if (header(context, path, title, open)) draw_properties(context, ref->node, path);
  }

  static bool header(GuiContext& context, const std::string& path, const std::string& title, bool open) {
    ImGui::PushStyleColor(ImGuiCol_Header, packed_color(ThemeColor::header));
    const float arrow = ImGui::GetFontSize() + 4 * ImGui::GetStyle().FramePadding.x;
    const std::string shown = elided(title, ImGui::GetContentRegionAvail().x - arrow, text_width);
    const bool is_open = ImGui::CollapsingHeader(fmt::format("{}###{}", shown, path).c_str(),
                                                 open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
    ImGui::PopStyleColor();
    context.names.add("section:" + path);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    return is_open;
  }

  static void draw_properties(GuiContext& context, std::uint32_t node, const std::string& path) {
    for (const Property& property : context.value_snapshot->tree->nodes()[node].table->properties()) {
      // available in the transport and the tree
      if (path == "/physics/sim" && property.kind == PropertyKind::action) continue;
      property_line(context, {{node, &property}, fmt::format("{}/{}", path, property.name)});
    }
  }

  PropertySearch search_;
  std::string words_;
  bool favorites_only_ = false;
};

[[maybe_unused]] const bool kParametersPanel = register_panel_type<ParametersPanel>({.name = "parameters",
                                                                                     .title = "Parameters",
                                                                                     .wide_slot = PanelSlot::right,
                                                                                     .compact_slot = PanelSlot::right,
                                                                                     .order = 0});

}  // namespace
}  // namespace limber::panel
