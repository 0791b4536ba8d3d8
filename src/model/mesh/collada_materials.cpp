// Materials of a Collada document: bindings of symbols, effects of the common profile, and their images.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/collada.h"
#include "model/xml_numbers.h"

namespace limber::model::collada {

namespace {

// the child of an effect's <newparam> with this sid, in the effect itself or in its profile
const Element* parameter(const Element* effect, std::string_view sid, const char* kind) {
  for (const Element* owner : {effect->FirstChildElement("profile_COMMON"), effect}) {
    for (const Element* e = owner ? owner->FirstChildElement("newparam") : nullptr; e;
         e = e->NextSiblingElement("newparam")) {
      const char* name = e->Attribute("sid");
      if (name && name == sid) return e->FirstChildElement(kind);
    }
  }
  return nullptr;
}

std::string_view text_of(const Element* element) {
  const char* text = element ? element->GetText() : nullptr;
  return trimmed(text ? text : "");
}

// The file of an <image>: its text, or that of <ref> inside.
std::string file_of(const Element* image) {
  const Element* from = image ? image->FirstChildElement("init_from") : nullptr;
  if (from == nullptr) return {};
  const Element* reference = from->FirstChildElement("ref");
  return std::string(text_of(reference ? reference : from));
}

// The <phong>, <lambert>, <blinn> or <constant> of an effect; null if there is none.
const Element* shading_of(const Element* effect) {
  const Element* profile = effect ? effect->FirstChildElement("profile_COMMON") : nullptr;
  const Element* technique = profile ? profile->FirstChildElement("technique") : nullptr;
  for (const char* kind : {"phong", "lambert", "blinn", "constant"}) {
    const Element* shading = technique ? technique->FirstChildElement(kind) : nullptr;
    if (shading) return shading;
  }
  return nullptr;
}

}  // namespace

std::vector<std::uint32_t> MaterialReader::bind(const Element* instance, const std::vector<std::string>& symbols) {
  const Element* binding = instance->FirstChildElement("bind_material");
  const Element* common = binding ? binding->FirstChildElement("technique_common") : nullptr;
  std::map<std::string_view, const char*> targets;
  for (const Element* e = common ? common->FirstChildElement("instance_material") : nullptr; e;
       e = e->NextSiblingElement("instance_material")) {
    const char* symbol = e->Attribute("symbol");
    if (symbol) targets.emplace(symbol, e->Attribute("target"));
  }
  std::vector<std::uint32_t> bound;
  for (const std::string& symbol : symbols) {
    const auto target = targets.find(symbol);
    // without a binding, some exporters mean the material of that id
    const char* const url = target != targets.end() ? target->second : symbol.c_str();
    const Element* material = symbol.empty() ? nullptr : ids_.find("material", url);
    if (material == nullptr && !symbol.empty()) {
      look_.report(Severity::warning, "material",
                   fmt::format("material {} not found; drawn white", quoted_word(symbol)), "Export the mesh again.");
    }
    bound.push_back(material ? read(material) : SoupLook::kNoMaterial);
  }
  return bound;
}

std::uint32_t MaterialReader::read(const Element* material) {
  const auto [known, is_new] = known_.try_emplace(material, SoupLook::kNoMaterial);
  if (!is_new) return known->second;
  MeshMaterial out;
  const char* name = material->Attribute("name");
  if (name == nullptr) name = material->Attribute("id");
  out.name = name ? name : "";
  const Element* instance = material->FirstChildElement("instance_effect");
  const Element* effect = instance ? ids_.find("effect", instance->Attribute("url")) : nullptr;
  const Element* shading = effect ? shading_of(effect) : nullptr;
  if (shading == nullptr) {
    look_.report(
        Severity::warning, "shading",
        fmt::format("material '{}' has no phong, lambert, blinn or constant shading; drawn white", printable(out.name)),
        "Export the mesh again with the common profile.");
    return SoupLook::kNoMaterial;
  }
  read_shading(shading, effect, out);
  return known->second = look_.add(std::move(out));
}

void MaterialReader::read_shading(const Element* shading, const Element* effect, MeshMaterial& out) {
  const Element* emission = shading->FirstChildElement("emission");
  // constant shading has no diffuse color: it shows its emission, whatever the light
  const bool constant = is_named(shading, "constant");
  const Element* diffuse = constant ? emission : shading->FirstChildElement("diffuse");
  out.color = color_of(diffuse, Vec3(1));
  const Element* texture = diffuse ? diffuse->FirstChildElement("texture") : nullptr;
  if (texture != nullptr) out.image = image_of(texture, effect);
  if (!constant) out.emission = color_of(emission, Vec3(0));
  for (const char* channel : {"emission", "ambient", "specular", "transparent", "bump"}) {
    const Element* e = shading->FirstChildElement(channel);
    const Element* image = e && e != diffuse ? e->FirstChildElement("texture") : nullptr;
    // the image of the diffuse color is often named again for the ambient color
    if (image == nullptr || is_named(e, "ambient")) continue;
    look_.report(Severity::note, "channel",
                 fmt::format("material '{}': the texture of <{}> is not drawn", printable(out.name), channel),
                 "Nothing to do; only textures of <diffuse> are supported.");
  }
  read_opacity(shading, out);
}

// <transparent> and <transparency>, see "Determining Transparency" in the Collada specification
void MaterialReader::read_opacity(const Element* shading, MeshMaterial& out) {
  const Element* transparent = shading->FirstChildElement("transparent");
  const Element* factor = shading->FirstChildElement("transparency");
  const Element* number = factor ? factor->FirstChildElement("float") : nullptr;
  const std::optional<double> read = number ? parse_number(text_of(number)) : std::nullopt;
  if (transparent == nullptr && !read) return;
  const double transparency = std::clamp(read.value_or(1), 0.0, 1.0);
  std::array<double, 4> rgba{1, 1, 1, 1};
  const Element* color = transparent ? transparent->FirstChildElement("color") : nullptr;
  if (color != nullptr) {
    const Result<std::vector<double>> numbers = numbers_of(color, 4);
    if (numbers) std::copy_n(numbers->begin(), 4, rgba.begin());
  }
  const char* mode = transparent ? transparent->Attribute("opaque") : nullptr;
  const std::string_view opaque = mode ? mode : "A_ONE";
  const double luminance = 0.212671 * rgba[0] + 0.715160 * rgba[1] + 0.072169 * rgba[2];
  double alpha = transparency * rgba[3];
  if (opaque == "RGB_ZERO") alpha = color ? 1 - transparency * luminance : 1;
  if (opaque == "RGB_ONE") alpha = transparency * luminance;
  if (opaque == "A_ZERO") alpha = 1 - transparency * rgba[3];
  out.alpha = std::clamp(alpha, 0.0, 1.0);
}

Vec3 MaterialReader::color_of(const Element* channel, const Vec3& fallback) {
  const Element* color = channel ? channel->FirstChildElement("color") : nullptr;
  if (color == nullptr) return fallback;
  const Result<std::vector<double>> numbers = numbers_of(color, 3);
  if (!numbers) {
    look_.report(Severity::warning, "color", fmt::format("{} The color is ignored", numbers.error()),
                 "Export the mesh again.");
    return fallback;
  }
  Vec3 out;
  for (int i = 0; i < 3; ++i) out[i] = std::clamp((*numbers)[static_cast<std::size_t>(i)], 0.0, 1.0);
  return out;
}

// A <texture> names a sampler, which names a surface, which names an image; some files name the image directly.
std::string MaterialReader::image_of(const Element* texture, const Element* effect) {
  const char* attribute = texture->Attribute("texture");
  std::string id = attribute ? attribute : "";
  if (const Element* sampler = parameter(effect, id, "sampler2D")) {
    const Element* instance = sampler->FirstChildElement("instance_image");
    const char* url = instance ? instance->Attribute("url") : nullptr;
    id = url ? std::string(url) : std::string(text_of(sampler->FirstChildElement("source")));
  }
  if (const Element* surface = parameter(effect, id, "surface")) id = text_of(surface->FirstChildElement("init_from"));
  std::string file = file_of(ids_.find("image", id.c_str()));
  if (file.empty()) {
    look_.report(Severity::warning, "image",
                 fmt::format("image {} not found; its surfaces are drawn without it", quoted_word(id)),
                 "Export the mesh again.");
  }
  return file;
}

}  // namespace limber::model::collada
