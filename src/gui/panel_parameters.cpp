// Parameters: the rows of what is chosen, of the scene, the world and the picture; search over all; favourites.
#include <array>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "base/text.h"
#include "gui/icons.h"
#include "gui/panel.h"
#include "gui/property_widget.h"
#include "gui/row_search.h"
#include "gui/search_field.h"
#include "gui/theme.h"

namespace limber {

namespace {

struct TopSection {
  const char* path;
  const char* title;
  bool open;
};
constexpr std::array kTopSections = {
    TopSection{"/scene", "scene", true},
    TopSection{"/physics/sim", "world", true},
    TopSection{"/visuals/look", "look", true},
    TopSection{"/visuals", "background", false},
    TopSection{"/visuals/camera", "camera", false},
};

class ParametersPanel : public Panel {
 public:
  void hear(Desk& desk) override {
    if (desk.image == nullptr) return;
    search_.look_for(words_);
    search_.go_on(desk.image->tree);
  }

  void draw(Desk& desk) override {
    const float side = ImGui::GetFrameHeight() * 1.15F;
    if (std::exchange(desk.focus_search, false)) {
      ImGui::SetWindowFocus();  // Dear ImGui 1.90.1 focuses items of the focused window only
      ImGui::SetKeyboardFocusHere();
    }
    search_field(desk, "parameters.search", "search (Ctrl+F)", words_,
                 ImGui::GetContentRegionAvail().x - side - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SameLine();
    if (icon_button(desk.names, "parameters.favourites", Icon::star, "favourites alone", favourites_, side))
      favourites_ = !favourites_;
    if (!ImGui::BeginChild("##rows", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    if (search_.active()) {
      show_found(desk);
    } else if (favourites_) {
      show_favourites(desk);
    } else {
      if (!desk.selected.empty()) show_chosen(desk);
      for (const TopSection& section : kTopSections) {
        if (desk.selected != section.path) show_thing(desk, section.path, section.title, section.open);
      }
    }
    ImGui::EndChild();
  }

 private:
  void show_found(Desk& desk) {
    for (const PlacedRow& at : search_.found()) {
      if (favourites_ && !desk.settings.favourites.contains(at.path)) continue;
      property_row(desk, at, {.star = true, .with_path = true, .name_part = 0.36});
    }
    if (search_.done() && search_.found().empty()) ImGui::TextDisabled("nothing is called so");
    if (search_.more()) ImGui::TextDisabled("there are more; another word narrows it");
    if (!search_.done()) ImGui::TextDisabled("looking…");
  }

  void show_favourites(Desk& desk) {
    const std::set<std::string> paths = desk.settings.favourites;  // a star may be taken away meanwhile
    for (const std::string& path : paths) {
      if (const auto at = desk.find(path))
        property_row(desk, *at, {.star = true, .with_path = true, .name_part = 0.36});
    }
    if (paths.empty()) ImGui::TextDisabled("a star in front of a row makes it a favourite");
  }

  // one of several (a pattern) stands for all of them: what is set is set in all
  static void show_chosen(Desk& desk) {
    PatternBudget budget;
    const std::string path = desk.selected;
    std::uint32_t node = 0;
    std::size_t count = 1;
    if (path.find('*') == std::string::npos) {
      const Result<TreePlace> place = desk.image->tree->find(path);
      if (place && place->row == nullptr) node = place->node;
    } else if (const auto rows = desk.image->tree->match(path + "/active", budget, 100000); rows && !rows->empty()) {
      node = rows->front().node;
      count = rows->size();
    }
    if (node == 0) {
      desk.selected.clear();  // it has gone
      return;
    }
    const std::string_view name = desk.image->tree->name(node);
    const std::string title = count > 1 ? fmt::format("{}  \u00d7{}", name, count) : std::string(name);
    if (header(desk, path, title, true)) rows(desk, node, path);
  }

  static void show_thing(Desk& desk, const char* path, const char* title, bool open) {
    const Result<TreePlace> place = desk.image->tree->find(path);
    if (!place || place->row != nullptr || desk.image->tree->nodes()[place->node].table->rows().empty()) return;
    if (header(desk, path, title, open)) rows(desk, place->node, path);
  }

  static bool header(Desk& desk, const std::string& path, const std::string& title, bool open) {
    ImGui::PushStyleColor(ImGuiCol_Header, packed(Tone::head));
    const bool shown = ImGui::CollapsingHeader(fmt::format("{}###{}", title, path).c_str(),
                                               open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
    ImGui::PopStyleColor();
    desk.names.note("section:" + path);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    return shown;
  }

  static void rows(Desk& desk, std::uint32_t node, const std::string& path) {
    for (const Row& row : desk.image->tree->nodes()[node].table->rows()) {
      // what transport and tree have of their own
      if (path == "/physics/sim" && row.kind == RowKind::action) continue;
      property_row(desk, {{node, &row}, fmt::format("{}/{}", path, row.name)});
    }
  }

  RowSearch search_;
  std::string words_;
  bool favourites_ = false;
};

[[maybe_unused]] const bool kParametersPanel = panel<ParametersPanel>(
    {.name = "parameters", .title = "Parameters", .wide = Slot::right, .compact = Slot::right, .order = 0});

}  // namespace
}  // namespace limber
