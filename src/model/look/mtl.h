// Reads material files of OBJ meshes (.mtl). Internal to the module: only src/model includes it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "model/look/soup_look.h"

namespace limber::model {

/// Adds the file's materials to the look, and their indices to `materials` by name; the first of a name is used. Reads
/// Kd, Ke, d, Tr and map_Kd; reports other maps, and values that can't be read. [any]
void read_mtl(std::string_view text, SoupLook& look, std::map<std::string, std::uint32_t, std::less<>>& materials);

}  // namespace limber::model
