// Scene: the object tree; the parameters panel shows the properties of the selected object.
#include <algorithm>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "ui/panel/gui.h"
#include "ui/panel/panel.h"
#include "ui/panel/text/labels.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/icons.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/tree_list.h"

namespace limber::panel {

namespace {

class ScenePanel : public Panel {
 public:
  std::string badge(const GuiContext& context) const override {
    return context.snapshot == nullptr || context.snapshot->body_list == nullptr
               ? ""
               : fmt::format("{}", context.snapshot->body_list->bodies.size());
  }

  void draw(GuiContext& context) override {
    draw_save(context);
    search_field(context.names, "scene.search", "Filter bodies, parts, joints", words_, -1);
    if (!ImGui::BeginChild("##tree", {}, false, ImGuiWindowFlags_NavFlattened)) return ImGui::EndChild();
    const std::shared_ptr<const TreeSnapshot>& tree = context.value_snapshot->tree;
    // look up the selection only if it or the tree has changed
    if (tree != selection_tree_ || context.selected != selection_path_) {
      const Result<TreePropertyRef> ref = tree->find(context.selected.empty() ? "/" : context.selected);
      selected_ = ref && ref->property == nullptr ? ref->node : 0;
      selection_tree_ = tree;
      selection_path_ = context.selected;
    }
    list_.lines(tree, words_);
    if (!context.requests.reveal_path.empty()) reveal(context);
    const std::vector<TreeList::Line>& lines = list_.lines(tree, words_);
    std::uint32_t toggled = 0;
    const float height = ImGui::GetTextLineHeightWithSpacing();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(lines.size()), height);
    while (clipper.Step()) {
      const auto shown = std::span(lines).subspan(static_cast<std::size_t>(clipper.DisplayStart),
                                                  static_cast<std::size_t>(clipper.DisplayEnd - clipper.DisplayStart));
      const std::vector<std::string> titles = titles_of(*tree, shown);
      for (std::size_t i = 0; i < shown.size(); i++) {
        if (draw_line(context, *tree, shown[i], titles[i])) toggled = shown[i].node;
      }
    }
    if (scroll_to_ >= 0) ImGui::SetScrollY(height * static_cast<float>(scroll_to_) - ImGui::GetWindowHeight() / 2);
    scroll_to_ = -1;
    if (toggled != 0) list_.toggle(toggled);
    if (lines.empty()) ImGui::TextDisabled("No results");
    ImGui::EndChild();
  }

 private:
  // The button and the small window that ask for the file of the scene to write, if a model plays.
  void draw_save(GuiContext& context) {
    if (context.options == nullptr || !context.options->save_scene) return;
    if (ImGui::Button("Save as scene…", {-1, 0})) {
      if (file_.empty()) file_ = context.options->scene_file;
      save_error_.clear();
      ImGui::OpenPopup("save_scene");
    }
    context.names.add("scene.save");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Write a Lua scene that loads this model, with comments to start from");
    if (!ImGui::BeginPopup("save_scene")) return;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 18);
    bool saves = ImGui::InputText("File", &file_, ImGuiInputTextFlags_EnterReturnsTrue);
    context.names.add("scene.save_file");
    saves |= ImGui::Button("Save");
    context.names.add("scene.save_write");
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) ImGui::CloseCurrentPopup();
    context.names.add("scene.save_cancel");
    if (!save_error_.empty()) {
      ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
      ImGui::TextUnformatted(save_error_.c_str());
      ImGui::PopTextWrapPos();
    }
    if (saves) save(context);
    ImGui::EndPopup();
  }

  // Writes the scene, after a question if the file exists.
  void save(GuiContext& context) {
    std::error_code error;
    if (std::filesystem::exists(file_, error)) {
      context.requests.confirmation = {fmt::format("{} exists. Replace it?", file_), "Replace", {}, [this, &context] {
                                         write(context, true);
                                         if (!save_error_.empty()) context.show_notice(save_error_);
                                       }};
      return ImGui::CloseCurrentPopup();
    }
    write(context, false);
    if (save_error_.empty()) ImGui::CloseCurrentPopup();
  }

  void write(GuiContext& context, bool overwrite) {
    const Result<void> saved = context.options->save_scene(file_, overwrite);
    save_error_ = saved ? std::string() : saved.error();
    if (saved) context.show_notice(fmt::format("Saved: {}", file_));
  }

  static float indent_of(const TreeList::Line& l) {
    return ImGui::GetFontSize() * 0.85F * (static_cast<float>(l.depth) + 1.2F);
  }

  // Returns the titles of lines, shortened to the width, different for all children of an object.
  static std::vector<std::string> titles_of(const TreeSnapshot& tree, std::span<const TreeList::Line> lines) {
    std::vector<std::string> titles(lines.size());
    std::map<std::uint32_t, std::vector<std::size_t>> siblings;
    for (std::size_t i = 0; i < lines.size(); i++) siblings[tree.nodes()[lines[i].node].parent].push_back(i);
    for (const auto& [parent, members] : siblings) {
      std::vector<std::string> names;
      for (const std::size_t i : members) names.emplace_back(TreeList::title(tree, lines[i].node));
      const TreeList::Line& first = lines[members.front()];
      float width = ImGui::GetContentRegionAvail().x - indent_of(first);
      const auto is_group = [&](std::size_t i) { return tree.nodes()[lines[i].node].table->properties().empty(); };
      if (std::ranges::any_of(members, is_group)) width -= text_width("00000");  // for the number of members
      const std::vector<std::string> texts = elided_apart(names, width, text_width);
      for (std::size_t k = 0; k < members.size(); k++) titles[members[k]] = texts[k];
    }
    return titles;
  }

  // Returns true if the line was expanded or collapsed.
  bool draw_line(GuiContext& context, const TreeSnapshot& tree, const TreeList::Line& l, const std::string& title) {
    const TreeSnapshot::Node& node = tree.nodes()[l.node];
    const float indent = ImGui::GetFontSize() * 0.85F;
    const float height = ImGui::GetTextLineHeight();
    ImGui::PushID(static_cast<int>(l.node));
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float x = from.x + indent_of(l);
    const bool pressed = ImGui::Selectable("##line", l.node == selected_, 0, {0, height});
    const std::string path = tree.path(l.node);
    context.names.add("tree:" + path);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    bool toggled = false;
    const bool group = node.table->properties().empty();
    if (pressed) {
      const bool on_arrow = l.expandable && ImGui::GetIO().MousePos.x < x && !ImGui::GetIO().NavVisible;
      toggled = l.expandable && (on_arrow || group || l.node == selected_);
      if (!on_arrow && !group) context.selected = path;
    }
    if (l.expandable)
      draw_icon(l.expanded ? Icon::down : Icon::right, x - indent * 0.62F, from.y + height / 2, height * 0.24F,
                packed_color(ThemeColor::secondary));
    ImGui::GetWindowDrawList()->AddText({x, from.y}, packed_color(group ? ThemeColor::secondary : ThemeColor::text),
                                        title.c_str());
    if (group && l.depth <= 3) draw_member_count(tree, l.node, from);
    ImGui::PopID();
    return toggled;
  }

  // Draws the number of members of a group.
  static void draw_member_count(const TreeSnapshot& tree, std::uint32_t group, const ImVec2& from) {
    int members = 0;
    tree.each_child(group, [&](std::uint32_t) { return ++members < 100000; });
    const std::string text = fmt::format("{}", members);
    const float right = from.x + ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
    ImGui::GetWindowDrawList()->AddText({right, from.y}, packed_color(ThemeColor::secondary), text.c_str());
  }

  void reveal(GuiContext& context) {
    const Result<TreePropertyRef> ref = context.value_snapshot->tree->find(context.requests.reveal_path);
    context.requests.reveal_path.clear();
    if (!ref) return;
    words_.clear();
    list_.reveal(ref->node);
    const std::vector<TreeList::Line>& lines = list_.lines(context.value_snapshot->tree, words_);
    for (std::size_t i = 0; i < lines.size(); i++) {
      if (lines[i].node == ref->node) scroll_to_ = static_cast<int>(i);
    }
  }

  TreeList list_;
  std::string words_;
  std::shared_ptr<const TreeSnapshot> selection_tree_;
  std::string selection_path_;
  std::string file_;        // of the scene to save
  std::string save_error_;  // of the last attempt
  std::uint32_t selected_ = 0;
  int scroll_to_ = -1;
};

[[maybe_unused]] const bool kScenePanel = register_panel_type<ScenePanel>(
    {.name = "scene", .title = "Scene", .wide_slot = PanelSlot::left, .compact_slot = PanelSlot::right, .order = 1});

}  // namespace
}  // namespace limber::panel
