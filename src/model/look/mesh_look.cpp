// Comparison of the colors of meshes.
#include "model/look/mesh_look.h"

#include <algorithm>

namespace limber::model {

std::vector<MeshMaterial> drawn_materials(const PlacedShape& shape) {
  if (shape.shape.mesh != nullptr && shape.shape.mesh_colors && has_colors(*shape.shape.mesh))
    return shape.shape.mesh->look->materials;
  MeshMaterial material;
  material.color = shape.color.value_or(Vec3(1));
  material.alpha = shape.alpha;
  material.texture = shape.shape.texture;
  if (material.texture != nullptr) material.image = material.texture->file;
  return {material};
}

bool same_image(const std::shared_ptr<const Image>& a, const std::shared_ptr<const Image>& b) {
  return a == b || (a != nullptr && b != nullptr && a->content_hash == b->content_hash);
}

namespace {

bool same_material(const MeshMaterial& a, const MeshMaterial& b) {
  return a.name == b.name && a.color == b.color && a.emission == b.emission && a.alpha == b.alpha &&
         same_image(a.texture, b.texture);
}

}  // namespace

bool same_look(const MeshModel& a, const MeshModel& b) {
  if (a.look == b.look) return true;
  static const MeshLook none;
  const MeshLook& x = a.look != nullptr ? *a.look : none;
  const MeshLook& y = b.look != nullptr ? *b.look : none;
  return std::equal(x.materials.begin(), x.materials.end(), y.materials.begin(), y.materials.end(), &same_material) &&
         x.triangle_materials == y.triangle_materials && x.texcoords == y.texcoords && x.colors == y.colors;
}

}  // namespace limber::model
