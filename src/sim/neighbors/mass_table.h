// MassTable: a table of the constant mass properties of all parts, in contiguous arrays that scripts read directly
// to compute centers of mass and inertias. [sim]
#pragma once

#include <cstdint>
#include <vector>

namespace limber::sim {

class Part;

/// The mass distribution of a part.
struct MassProperties {
  double center[3];        ///< Center of mass in the link's frame, m.
  double unit_inertia[3];  ///< Principal moments for a mass of 1 kg, m².
};

class MassTable {
 public:
  /// Layout known to script/api/c_api.inc. The arrays are reallocated when parts are added: read the pointers again
  /// from the same View.
  struct View {
    const MassProperties* list = nullptr;
    const std::int32_t* index_of_slot = nullptr;  ///< Index in `list` by the slot of a living part's node.
  };

  /// Adds a part, at the same index as in the world's ForceAccumulators. A removed part's entry is reused.
  void add(const Part& part);
  /// Fills `copy`, and updates it when arrays are reallocated, until unregister_view().
  void register_view(View& copy);
  void unregister_view(View& copy);

 private:
  std::vector<MassProperties> entries_;
  std::vector<std::int32_t> index_of_slot_;
  std::vector<View*> views_;
};

}  // namespace limber::sim
