// The function table, its text for LuaJIT, and checks that the C structs match the C++ layouts.
#include "script/api/c_api.h"

#include <cstddef>

#include "properties/store.h"
#include "script/vm/pattern_match.h"
#include "sim/neighbors/mass_table.h"
#include "sim/neighbors/neighbor_set.h"

namespace limber::script {

static_assert(sizeof(LimberSlot) == sizeof(NodeSlot));
static_assert(offsetof(LimberSlot, generation) == offsetof(NodeSlot, generation));
static_assert(offsetof(LimberSlot, table) == offsetof(NodeSlot, table));
static_assert(offsetof(LimberSlot, persistent) == offsetof(NodeSlot, persistent));
static_assert(offsetof(LimberSlot, transient) == offsetof(NodeSlot, transient));
static_assert(sizeof(LimberMatch) == sizeof(Match));
static_assert(offsetof(LimberMatch, count) == offsetof(Match, count));
static_assert(offsetof(LimberMatch, from) == offsetof(Match, from));
static_assert(offsetof(LimberMatch, length) == offsetof(Match, length));
static_assert(sizeof(LimberView) == sizeof(StoreView));
static_assert(offsetof(LimberView, slots) == offsetof(StoreView, slots));
static_assert(offsetof(LimberView, persistent) == offsetof(StoreView, persistent));
static_assert(offsetof(LimberView, transient) == offsetof(StoreView, transient));
static_assert(offsetof(LimberView, slot_count) == offsetof(StoreView, slot_count));

static_assert(sizeof(LimberMassEntry) == sizeof(sim::MassProperties));
static_assert(offsetof(LimberMassEntry, inertia_x) == offsetof(sim::MassProperties, unit_inertia));
static_assert(sizeof(LimberMassTable) == sizeof(sim::MassTable::View));
static_assert(offsetof(LimberMassTable, indices) == offsetof(sim::MassTable::View, index_of_slot));
static_assert(sizeof(LimberNeighbor) == sizeof(sim::Neighbor));
static_assert(offsetof(LimberNeighbor, index) == offsetof(sim::Neighbor, index));
static_assert(offsetof(LimberNeighbor, x) == offsetof(sim::Neighbor, offset));
static_assert(offsetof(LimberNeighbor, distance) == offsetof(sim::Neighbor, distance));

static_assert(sizeof(LimberMeans) == sizeof(sim::NeighborMeans));
static_assert(offsetof(LimberMeans, offset) == offsetof(sim::NeighborMeans, offset));
static_assert(offsetof(LimberMeans, velocity) == offsetof(sim::NeighborMeans, velocity));
static_assert(offsetof(LimberMeans, angular_velocity) == offsetof(sim::NeighborMeans, angular_velocity));
static_assert(offsetof(LimberMeans, separation) == offsetof(sim::NeighborMeans, separation));

const LimberApi& limber_api() {
  static const LimberApi api = {
#define LIMBER_STRUCT(...)
#define LIMBER_CALL(result, name, arguments) &calls::name,
#include "script/api/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
  };
  return api;
}

const std::string& limber_cdef() {
  static const std::string text =
#define LIMBER_STRUCT(...) #__VA_ARGS__ "\n"
#define LIMBER_CALL(result, name, arguments)
#include "script/api/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
      "struct LimberApi {\n"
#define LIMBER_STRUCT(...)
#define LIMBER_CALL(result, name, arguments) #result "(*" #name ")" #arguments ";\n"
#include "script/api/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
      "};\n";
  return text;
}

}  // namespace limber::script
