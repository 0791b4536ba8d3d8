// Reads the text of the last frame from its vertices: each glyph is recognized by its place in the font texture.
// Nothing of the panel's own code is used, so a test sees the same as a user.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <imgui.h>
#include <imgui_internal.h>

#include "ui/panel/layout.h"

namespace limber::panel::test {

struct DrawnGlyph {
  std::string character;  ///< UTF-8.
  double x = 0, y = 0;    ///< Where the character begins, and the top of its line.
  double advance = 0, height = 0;
  double left = 0, top = 0, right = 0, bottom = 0;  ///< Its pixels.
  bool cut = false;                                 ///< A part at the left or right is not drawn.
  unsigned color = 0;
};

/// A rectangle in one color.
struct DrawnBox {
  double left = 0, top = 0, right = 0, bottom = 0;
  unsigned color = 0;
};

class DrawnText {
 public:
  /// Reads the last frame of the current context.
  DrawnText() {
    for (ImFont* const font : ImGui::GetIO().Fonts->Fonts) {
      for (const ImFontGlyph& glyph : font->Glyphs) glyphs_by_place_[place_of(glyph)] = {font, &glyph};
    }
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int i = 0; i < data.CmdListsCount; i++) read_list(*data.CmdLists[i]);
  }

  const std::vector<DrawnGlyph>& glyphs() const { return glyphs_; }
  const std::vector<DrawnBox>& boxes() const { return boxes_; }

  /// Returns the text in a rectangle, with its lines joined by spaces, or nothing.
  std::string in(const PanelRect& rect) const {
    std::vector<DrawnGlyph> inside;
    for (const DrawnGlyph& g : glyphs_) {
      const double x = (g.left + g.right) / 2;
      const double y = g.y + g.height / 2;
      if (x >= rect.x && x <= rect.x + rect.width && y >= rect.y && y <= rect.y + rect.height) inside.push_back(g);
    }
    std::stable_sort(inside.begin(), inside.end(), [](const DrawnGlyph& a, const DrawnGlyph& b) {
      return std::abs(a.y - b.y) > 4 ? a.y < b.y : a.x < b.x;
    });
    std::string text;
    for (std::size_t i = 0; i < inside.size(); i++) {
      const bool new_line = i > 0 && std::abs(inside[i].y - inside[i - 1].y) > 4;
      const bool gap = i > 0 && inside[i].x - inside[i - 1].x - inside[i - 1].advance > inside[i].height * 0.12;
      if (gap && !new_line) text += ' ';
      text += inside[i].character;
    }
    return text;
  }

  /// Returns the pieces of text that are cut at the left or right.
  std::vector<std::string> cut() const {
    std::vector<std::string> pieces;
    for (const DrawnGlyph& g : glyphs_) {
      if (g.cut) pieces.push_back(in({g.x - 150, g.y, 300, g.height}));
    }
    return pieces;
  }

 private:
  struct FontGlyph {
    ImFont* font = nullptr;
    const ImFontGlyph* glyph = nullptr;
  };
  using Place = std::array<float, 4>;
  static Place place_of(const ImFontGlyph& g) { return {g.U0, g.V0, g.U1, g.V1}; }

  static std::string utf8(unsigned code) {
    if (code < 0x80) return {static_cast<char>(code)};
    if (code < 0x800) return {static_cast<char>(0xc0 | code >> 6), static_cast<char>(0x80 | (code & 0x3f))};
    return {static_cast<char>(0xe0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3f)),
            static_cast<char>(0x80 | (code & 0x3f))};
  }

  // Quads of which a part was cut off lie within the place of their glyph.
  FontGlyph find(const Place& place) const {
    if (const auto found = glyphs_by_place_.find(place); found != glyphs_by_place_.end()) return found->second;
    constexpr float kTouch = 1e-6F;
    for (const auto& [whole, glyph] : glyphs_by_place_) {
      if (place[0] >= whole[0] - kTouch && place[1] >= whole[1] - kTouch && place[2] <= whole[2] + kTouch &&
          place[3] <= whole[3] + kTouch && whole[2] > whole[0])
        return glyph;
    }
    return {};
  }

  void read_list(const ImDrawList& list) {
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    for (const ImDrawCmd& command : list.CmdBuffer) {
      for (unsigned i = command.IdxOffset; i + 5 < command.IdxOffset + command.ElemCount; i += 3) {
        const ImDrawIdx* const at = list.IdxBuffer.Data + i;
        if (at[1] != at[0] + 1 || at[2] != at[0] + 2 || at[3] != at[0] || at[4] != at[2] || at[5] != at[0] + 3)
          continue;
        const ImDrawVert* const corner = list.VtxBuffer.Data + command.VtxOffset + at[0];
        if (corner[0].uv.x == white.x && corner[2].uv.x == white.x) {
          const ImVec2 low = corner[0].pos;
          const ImVec2 high = corner[2].pos;
          if (corner[1].pos.y == low.y && corner[3].pos.x == low.x)
            boxes_.push_back({static_cast<double>(low.x), static_cast<double>(low.y), static_cast<double>(high.x),
                              static_cast<double>(high.y), corner[0].col});
          continue;
        }
        if (corner[0].uv.x >= corner[2].uv.x || corner[0].pos.y != corner[1].pos.y) continue;
        add(command, corner[0], corner[2]);
        i += 3;
      }
    }
  }

  void add(const ImDrawCmd& command, const ImDrawVert& low, const ImDrawVert& high) {
    const FontGlyph found = find({low.uv.x, low.uv.y, high.uv.x, high.uv.y});
    if (found.glyph == nullptr) return;
    const ImFontGlyph& g = *found.glyph;
    const ImVec4& clip = command.ClipRect;
    const bool visible = high.pos.y > clip.y && low.pos.y < clip.w && high.pos.x > clip.x && low.pos.x < clip.z;
    if (!visible) {
      // a glyph that is beside its clip rectangle is cut as well
      const bool beside = high.pos.y > clip.y && low.pos.y < clip.w;
      if (!beside) return;
    }
    const float per_pixel = (g.U1 - g.U0) / std::max(g.X1 - g.X0, 1e-6F);
    DrawnGlyph drawn;
    drawn.character = utf8(g.Codepoint);
    drawn.x = static_cast<double>(low.pos.x - (low.uv.x - g.U0) / per_pixel - g.X0);
    drawn.y = static_cast<double>(low.pos.y - g.Y0);
    drawn.advance = static_cast<double>(g.AdvanceX);
    drawn.height = static_cast<double>(found.font->FontSize);
    drawn.left = static_cast<double>(low.pos.x);
    drawn.top = static_cast<double>(low.pos.y);
    drawn.right = static_cast<double>(high.pos.x);
    drawn.bottom = static_cast<double>(high.pos.y);
    drawn.color = low.col;
    constexpr float kHair = 0.6F;  // transparent margin of a glyph
    const bool cut_finely = low.uv.x > g.U0 + 1e-6F || high.uv.x < g.U1 - 1e-6F;
    drawn.cut = cut_finely || low.pos.x < clip.x - kHair || high.pos.x > clip.z + kHair;
    glyphs_.push_back(drawn);
  }

  std::map<Place, FontGlyph> glyphs_by_place_;
  std::vector<DrawnGlyph> glyphs_;
  std::vector<DrawnBox> boxes_;
};

}  // namespace limber::panel::test
