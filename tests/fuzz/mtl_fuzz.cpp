// Fuzzes the reader of material files. Input: a .mtl file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.h"
#include "model/look/mtl.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::model::SoupLook look(nullptr);
  std::map<std::string, std::uint32_t, std::less<>> materials;
  limber::model::read_mtl({reinterpret_cast<const char*>(data), size}, look, materials);
  limber::must(materials.size() <= look.material_count() && look.material_count() <= limber::model::kMaxMeshMaterials);
  for (const auto& [name, index] : materials) look.paint(3 * (index + 1), index);
  const auto result = look.release(3 * look.material_count());
  if (result == nullptr) return 0;
  for (const limber::model::MeshMaterial& m : result->materials) {
    limber::must(m.alpha > 0 && m.alpha <= 1);
    for (int i = 0; i < 3; i++)
      limber::must(m.color[i] >= 0 && m.color[i] <= 1 && m.emission[i] >= 0 && m.emission[i] <= 1);
  }
  for (const std::uint32_t m : result->triangle_materials) limber::must(m < result->materials.size());
  return 0;
}
