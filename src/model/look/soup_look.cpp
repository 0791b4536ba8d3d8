// Materials and their textures, and the reports of a mesh file.
#include "model/look/soup_look.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::model {

std::uint32_t SoupLook::add(MeshMaterial material) {
  if (materials_.size() >= kMaxMeshMaterials) {
    report(Severity::warning, "materials",
           fmt::format("has more than {} materials; the others are drawn white", kMaxMeshMaterials),
           "Use fewer materials.");
    return kNoMaterial;
  }
  if (material.alpha <= 0) {
    // many exporters write 0 for opaque
    report(Severity::note, "invisible",
           fmt::format("material '{}' is completely transparent; drawn opaque", printable(material.name)),
           "Remove the surface if it is meant to be invisible.");
    material.alpha = 1;
  }
  if (material.texture != nullptr) {
    const auto [known, is_new] = images_.try_emplace(material.texture->file);
    if (is_new) known->second = within_limits(material.texture, material.image);
    material.texture = known->second;
  } else if (!material.image.empty()) {
    material.texture = load(material.image);
  }
  materials_.push_back(std::move(material));
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

std::shared_ptr<const Image> SoupLook::load(const std::string& name) {
  const auto [known, is_new] = images_.try_emplace(name);
  if (!is_new || files_ == nullptr || images_.size() > 2 * kMaxMeshTextures) return known->second;
  const Result<std::shared_ptr<const Image>> image = files_->image(name);
  if (!image) {
    const auto [text, fix] = split_fix(image.error(), "Fix the image.");
    report(Severity::warning, "texture", fmt::format("texture {}; its surfaces are drawn without it", text), fix);
    return nullptr;
  }
  return known->second = within_limits(*image, name);
}

std::shared_ptr<const Image> SoupLook::within_limits(std::shared_ptr<const Image> image, const std::string& name) {
  if (images_.size() > kMaxMeshTextures) {
    report(Severity::warning, "textures",
           fmt::format("has more than {} textures; the others are not drawn", kMaxMeshTextures),
           "Combine the images, or split the mesh.");
    return nullptr;
  }
  pixels_ += static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
  if (pixels_ <= kMaxTexturePixels) return image;
  report(Severity::warning, "pixels",
         fmt::format("has textures with more than {} million pixels; '{}' is not drawn", kMaxTexturePixels >> 20,
                     printable(name)),
         "Shrink its textures.");
  return nullptr;
}

void SoupLook::set_texcoord(std::size_t corner, const TexCoord& texcoord) {
  texcoords_.resize(std::max(texcoords_.size(), corner + 1));
  texcoords_[corner] = texcoord;
}

void SoupLook::set_color(std::size_t corner, const CornerColor& color) {
  colors_.resize(std::max(colors_.size(), corner + 1), {255, 255, 255, 255});
  colors_[corner] = color;
}

void SoupLook::report(Severity severity, const char* kind, std::string text, std::string fix) {
  Report& report = reports_[kind];
  if (report.count++ == 0) report.problem = {0, severity, std::move(text), std::move(fix)};
}

std::shared_ptr<MeshLook> SoupLook::release(std::size_t corners) {
  const auto no_material = [](std::uint32_t m) { return m == kNoMaterial; };
  triangle_materials_.resize(corners / 3, kNoMaterial);
  const bool painted = !std::all_of(triangle_materials_.begin(), triangle_materials_.end(), no_material);
  auto look = std::make_shared<MeshLook>();
  if (files_ != nullptr) {
    look->files = files_->used();
    for (const std::string& name : files_->misspelled()) {
      report(Severity::warning, "letter case", fmt::format("names '{}', whose letter case differs", printable(name)),
             "Rename the file: other systems tell them apart.");
    }
  }
  for (auto& [kind, report] : reports_) {
    if (report.count > 1) report.problem.text += fmt::format(" … and {} more of this kind", report.count - 1);
    look->problems.push_back(std::move(report.problem));
  }
  if (painted || !colors_.empty()) {
    look->materials = std::move(materials_);
    // triangles without a material are white
    if (std::any_of(triangle_materials_.begin(), triangle_materials_.end(), no_material)) {
      std::replace(triangle_materials_.begin(), triangle_materials_.end(), kNoMaterial,
                   static_cast<std::uint32_t>(look->materials.size()));
      look->materials.emplace_back();
    }
    look->triangle_materials = std::move(triangle_materials_);
    if (!colors_.empty()) colors_.resize(corners, {255, 255, 255, 255});
    look->colors = std::move(colors_);
  }
  // kept without colors as well, for a texture of the model file
  if (!texcoords_.empty()) texcoords_.resize(corners);
  look->texcoords = std::move(texcoords_);
  const bool empty =
      look->materials.empty() && look->texcoords.empty() && look->problems.empty() && look->files.empty();
  return empty ? nullptr : look;
}

}  // namespace limber::model
