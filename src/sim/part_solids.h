// PartSolids: what of each part never changes, side by side, for readers that make no calls: scripts work centres of
// mass and inertias out by themselves. [sim]
#pragma once

#include <cstdint>
#include <vector>

namespace limber {

class Part;

/// How a part's mass is spread.
struct PartSolid {
  double center[3];        ///< Centre of mass in the link's frame, m.
  double unit_inertia[3];  ///< Principal moments for a mass of 1 kg, m².
};

class PartSolids {
 public:
  /// Layout known to script/c_api.inc. The arrays move when parts are added: ask again through the same pointer.
  struct View {
    const PartSolid* list = nullptr;
    const std::int32_t* places = nullptr;  ///< In the list, by the slot of a living part's node.
  };

  /// A part with its place among the world's loads, which is its place here.
  void add(const Part& part);
  /// Keeps `copy` up to date until hide_view().
  void show_view(View& copy);
  void hide_view(View& copy);

 private:
  std::vector<PartSolid> list_;
  std::vector<std::int32_t> places_;
  std::vector<View*> views_;
};

}  // namespace limber
