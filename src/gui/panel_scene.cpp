// Scene: everything that is there as a tree; what is chosen shows its rows among the parameters.
#include <fmt/format.h>
#include <imgui.h>

#include "gui/icons.h"
#include "gui/panel.h"
#include "gui/search_field.h"
#include "gui/theme.h"
#include "gui/tree_list.h"

namespace limber {

namespace {

class ScenePanel : public Panel {
 public:
  std::string badge(const Desk& desk) const override {
    return desk.now == nullptr || desk.now->roster == nullptr ? "" : fmt::format("{}", desk.now->roster->bodies.size());
  }

  void draw(Desk& desk) override {
    search_field(desk, "scene.search", "filter bodies, parts, joints", words_, -1);
    if (!ImGui::BeginChild("##tree", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    const std::shared_ptr<const Tree>& tree = desk.image->tree;
    // a path to a node only when either has become another
    if (tree != bound_ || desk.selected != bound_path_) {
      const Result<TreePlace> place = tree->find(desk.selected.empty() ? "/" : desk.selected);
      chosen_ = place && place->row == nullptr ? place->node : 0;
      bound_ = tree;
      bound_path_ = desk.selected;
    }
    list_.lines(tree, words_);
    if (!desk.reveal.empty()) show(desk);
    const std::vector<TreeList::Line>& lines = list_.lines(tree, words_);
    std::uint32_t toggled = 0;
    const float height = ImGui::GetTextLineHeightWithSpacing();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines.size()), height);
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) {
        if (line(desk, *tree, lines[static_cast<std::size_t>(i)])) toggled = lines[static_cast<std::size_t>(i)].node;
      }
    }
    if (scroll_to_ >= 0) ImGui::SetScrollY(height * static_cast<float>(scroll_to_) - ImGui::GetWindowHeight() / 2);
    scroll_to_ = -1;
    if (toggled != 0) list_.toggle(toggled);
    if (lines.empty()) ImGui::TextDisabled("nothing is called so");
    ImGui::EndChild();
  }

 private:
  // true: it opens or closes
  bool line(Desk& desk, const Tree& tree, const TreeList::Line& l) {
    const Tree::Node& node = tree.nodes()[l.node];
    const float indent = ImGui::GetFontSize() * 0.85F;
    const float height = ImGui::GetTextLineHeight();
    ImGui::PushID(static_cast<int>(l.node));
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float x = from.x + indent * (static_cast<float>(l.depth) + 1.2F);
    const bool pressed = ImGui::Selectable("##line", l.node == chosen_, 0, {0, height});
    const std::string path = tree.path(l.node);
    desk.names.note("tree:" + path);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    bool toggled = false;
    const bool group = node.table->rows().empty();
    if (pressed) {
      const bool on_arrow = l.opens && ImGui::GetIO().MousePos.x < x && !ImGui::GetIO().NavVisible;
      toggled = l.opens && (on_arrow || group || l.node == chosen_);
      if (!on_arrow && !group) desk.selected = path;
    }
    if (l.opens)
      draw_icon(l.open ? Icon::down : Icon::right, x - indent * 0.62F, from.y + height / 2, height * 0.24F,
                packed(Tone::dim));
    const std::string_view title = TreeList::title(tree, l.node);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddText({x, from.y}, packed(group ? Tone::dim : Tone::text), title.data(), title.data() + title.size());
    if (group && l.depth <= 3) count(tree, l.node, from);
    ImGui::PopID();
    return toggled;
  }

  // how many there are in a group
  static void count(const Tree& tree, std::uint32_t group, const ImVec2& from) {
    int members = 0;
    tree.each_child(group, [&](std::uint32_t) { return ++members < 100000; });
    const std::string text = fmt::format("{}", members);
    const float right = from.x + ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
    ImGui::GetWindowDrawList()->AddText({right, from.y}, packed(Tone::dim), text.c_str());
  }

  void show(Desk& desk) {
    const Result<TreePlace> place = desk.image->tree->find(desk.reveal);
    desk.reveal.clear();
    if (!place) return;
    words_.clear();
    list_.reveal(place->node);
    const std::vector<TreeList::Line>& lines = list_.lines(desk.image->tree, words_);
    for (std::size_t i = 0; i < lines.size(); i++) {
      if (lines[i].node == place->node) scroll_to_ = static_cast<int>(i);
    }
  }

  TreeList list_;
  std::string words_;
  std::shared_ptr<const Tree> bound_;
  std::string bound_path_;
  std::uint32_t chosen_ = 0;
  int scroll_to_ = -1;
};

[[maybe_unused]] const bool kScenePanel =
    panel<ScenePanel>({.name = "scene", .title = "Scene", .wide = Slot::left, .compact = Slot::right, .order = 1});

}  // namespace
}  // namespace limber
