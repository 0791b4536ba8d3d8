// Scene, meshes and materials of a glTF file.
#include "model/mesh/gltf.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/color.h"
#include "base/text.h"
#include "base/vec.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"

namespace limber::model::gltf {

namespace {

constexpr std::size_t kMaxNodes = 100'000;
constexpr std::size_t kMaxWork = 12 * kMaxMeshTriangles;  // points, corners and primitives that are read
constexpr std::size_t kPrimitiveWork = 16;

struct Placement {
  Mat3 linear{1};
  Vec3 translation{0};
};

// The first numbers of an array of an object; `fallback` for absent ones.
template <std::size_t N>
std::array<double, N> numbers_of(const Json* object, const char* key, const std::array<double, N>& fallback) {
  std::array<double, N> out = fallback;
  const Json* const list = member(object, key);
  if (list == nullptr || !list->is_array()) return out;
  for (std::size_t i = 0; i < N && i < list->size(); ++i) {
    const double value = (*list)[i].is_number() ? (*list)[i].template get<double>() : fallback[i];
    if (std::isfinite(value)) out[i] = value;
  }
  return out;
}

Placement placement_of(const Json& node) {
  if (node.contains("matrix")) {
    const auto m = numbers_of<16>(&node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});  // by columns
    return {Mat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]), {m[12], m[13], m[14]}};
  }
  const auto t = numbers_of<3>(&node, "translation", {0, 0, 0});
  const auto r = numbers_of<4>(&node, "rotation", {0, 0, 0, 1});
  const auto s = numbers_of<3>(&node, "scale", {1, 1, 1});
  const Quat rotation = quat_xyzw(r[0], r[1], r[2], r[3]);
  const double length = glm::length(rotation);
  const Mat3 turn = length > 1e-9 ? glm::mat3_cast(rotation / length) : Mat3(1);
  return {turn * Mat3(s[0], 0, 0, 0, s[1], 0, 0, 0, s[2]), {t[0], t[1], t[2]}};
}

class Reader {
 public:
  Reader(Document& document, SoupLook* look, SoupObjects* objects)
      : document_(document), json_(document.json()), look_(look), objects_(objects) {}

  Result<MeshSoup> read() {
    // y up to z up
    const Placement root{Mat3(1, 0, 0, 0, 0, 1, 0, -1, 0), Vec3(0)};
    const Json zero = 0u;
    const Json* index = member(&json_, "scene");
    const Json* const scene = element(json_, "scenes", index != nullptr ? index : &zero);
    if (scene == nullptr) return Error{"has no scene. Export it again."};
    std::vector<std::pair<const Json*, Placement>> stack;
    push_children(member(scene, "nodes"), root, stack);
    for (std::size_t visited = 0; !stack.empty(); ++visited) {
      if (visited >= kMaxNodes) return Error{"has too many nodes, or nodes in a cycle. Simplify it."};
      const auto [node, above] = stack.back();
      stack.pop_back();
      const Placement own = placement_of(*node);
      const Placement at{above.linear * own.linear, above.linear * own.translation + above.translation};
      if (const Json* const mesh = element(json_, "meshes", member(node, "mesh"))) {
        if (const Result<void> added = add_mesh(*mesh, at); !added) return Error{added.error()};
      }
      push_children(member(node, "children"), at, stack);
    }
    return std::move(soup_);
  }

 private:
  void push_children(const Json* list, const Placement& at, std::vector<std::pair<const Json*, Placement>>& stack) {
    if (list == nullptr || !list->is_array() || stack.size() > kMaxNodes) return;
    for (auto child = list->rbegin(); child != list->rend(); ++child) {
      if (const Json* const node = element(json_, "nodes", &*child)) stack.emplace_back(node, at);
    }
  }

  Result<void> add_mesh(const Json& mesh, const Placement& at) {
    const Json* const primitives = member(&mesh, "primitives");
    if (primitives == nullptr || !primitives->is_array()) return {};
    for (const Json& primitive : *primitives) {
      if (const Result<void> added = add_primitive(primitive, at); !added) return added;
    }
    return {};
  }

  // the corners of each triangle
  Result<std::vector<std::size_t>> corners_of(const Json& primitive, std::size_t points, double mode) {
    std::vector<std::size_t> listed;
    if (const Json* const indices = member(&primitive, "indices")) {
      const Result<std::vector<double>> read = document_.numbers(indices, 1, 3 * kMaxMeshTriangles);
      if (!read) return Error{read.error()};
      for (const double index : *read) {
        if (!(index >= 0 && index < static_cast<double>(points)))
          return Error{fmt::format("has a triangle with point {}, but {} points. Export it again.", index, points)};
        listed.push_back(static_cast<std::size_t>(index));
      }
    } else {
      for (std::size_t i = 0; i < points; ++i) listed.push_back(i);
    }
    constexpr double kStrip = 5, kFan = 6;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i + 2 < listed.size(); i += mode == kStrip || mode == kFan ? 1 : 3) {
      const std::size_t odd = mode == kStrip ? i % 2 : 0;
      out.insert(out.end(), {listed[mode == kFan ? 0 : i], listed[i + 1 + odd], listed[i + 2 - odd]});
    }
    return out;
  }

  // numbers of an attribute for each point; empty if it is absent, or can't be read (reported)
  std::vector<double> optional_attribute(const Json* attributes, const char* name, std::size_t components,
                                         std::size_t points) {
    const Json* const index = member(attributes, name);
    if (index == nullptr || look_ == nullptr) return {};
    Result<std::vector<double>> read = document_.numbers(index, components, points);
    if (read && read->size() == components * points) return std::move(*read);
    look_->report(Severity::warning, name, fmt::format("{} can't be read; drawn without it", name),
                  "Export the mesh again.");
    return {};
  }

  Result<void> add_primitive(const Json& primitive, const Placement& at) {
    constexpr double kTriangles = 4;
    const double mode = number(primitive, "mode", kTriangles);
    const Json* const attributes = member(&primitive, "attributes");
    const Json* const position = member(attributes, "POSITION");
    if (mode < kTriangles || position == nullptr) return {};  // points and lines
    const Result<std::vector<double>> points = document_.numbers(position, 3, 3 * kMaxMeshTriangles);
    if (!points) return Error{points.error()};
    const std::size_t count = points->size() / 3;
    // nodes can instance a mesh often
    work_ += kPrimitiveWork + count;
    if (work_ > kMaxWork) return too_many_triangles();
    const Result<std::vector<std::size_t>> corners = corners_of(primitive, count, mode);
    if (!corners) return Error{corners.error()};
    work_ += corners->size();
    if (soup_.size() + corners->size() > 3 * kMaxMeshTriangles) return too_many_triangles();
    const std::vector<double> texcoords = optional_attribute(attributes, "TEXCOORD_0", 2, count);
    const std::vector<double> colors = optional_attribute(attributes, "COLOR_0", 3, count);
    const bool flipped = glm::determinant(at.linear) < 0;
    for (std::size_t i = 0; i + 2 < corners->size(); i += 3) {
      for (const std::size_t k : {i, flipped ? i + 2 : i + 1, flipped ? i + 1 : i + 2}) {
        const std::size_t p = (*corners)[k];
        if (!texcoords.empty()) look_->set_texcoord(soup_.size(), texcoord_at(texcoords, p));
        if (!colors.empty()) look_->set_color(soup_.size(), color_at(colors, p));
        soup_.push_back(at.linear * Vec3((*points)[3 * p], (*points)[3 * p + 1], (*points)[3 * p + 2]) +
                        at.translation);
      }
    }
    if (look_ != nullptr) look_->paint(soup_.size(), material(member(&primitive, "material")));
    if (objects_ != nullptr) objects_->resize(soup_.size() / 3, object_++);
    return {};
  }

  static TexCoord texcoord_at(const std::vector<double>& all, std::size_t point) {
    return {static_cast<float>(std::clamp(all[2 * point], -1e4, 1e4)),
            static_cast<float>(std::clamp(all[2 * point + 1], -1e4, 1e4))};
  }
  // colors of vertices are linear
  static CornerColor color_at(const std::vector<double>& all, std::size_t point) {
    CornerColor out{255, 255, 255, 255};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = static_cast<std::uint8_t>(255 * encoded_of(std::clamp(all[3 * point + i], 0.0, 1.0)) + 0.5);
    return out;
  }

  std::uint32_t material(const Json* index) {
    const Json* const found = element(json_, "materials", index);
    if (found == nullptr) return SoupLook::kNoMaterial;
    const auto [known, is_new] = materials_.try_emplace(found, SoupLook::kNoMaterial);
    if (!is_new) return known->second;
    MeshMaterial out;
    out.name = text(*found, "name");
    const Json* const surface = member(found, "pbrMetallicRoughness");
    const auto factor = numbers_of<4>(surface, "baseColorFactor", {1, 1, 1, 1});
    const auto emission = numbers_of<3>(found, "emissiveFactor", {0, 0, 0});
    for (std::size_t i = 0; i < 3; ++i) {
      out.color[static_cast<int>(i)] = encoded_of(std::clamp(factor[i], 0.0, 1.0));
      out.emission[static_cast<int>(i)] = encoded_of(std::clamp(emission[i], 0.0, 1.0));
    }
    const std::string mode = text(*found, "alphaMode");
    if (mode == "BLEND") out.alpha = std::clamp(factor[3], 0.0, 1.0);
    if (mode == "MASK") {
      look_->report(Severity::note, "mask",
                    fmt::format("material '{}' has cut-outs; drawn opaque", printable(out.name)), "Nothing to do.");
    }
    set_texture(member(surface, "baseColorTexture"), out);
    for (const char* other : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
      if (!found->contains(other)) continue;
      look_->report(Severity::note, "map", fmt::format("material '{}': {} is not drawn", printable(out.name), other),
                    "Nothing to do; only baseColorTexture is supported.");
    }
    return known->second = look_->add(std::move(out));
  }

  void set_texture(const Json* reference, MeshMaterial& out) {
    const Json* const texture = element(json_, "textures", member(reference, "index"));
    if (texture == nullptr) return;
    const Json* const source = member(texture, "source");
    const Json* const image = element(json_, "images", source);
    if (image == nullptr) return;
    const std::string uri = text(*image, "uri");
    if (!uri.empty() && !uri.starts_with("data:")) {
      out.image = uri;
      return;
    }
    out.image = fmt::format("image {}", source->get<std::uint64_t>());
    const auto [known, is_new] = images_.try_emplace(image);
    if (is_new) known->second = decode(*image, uri, out.image);
    out.texture = known->second;
    if (out.texture == nullptr) out.image.clear();
  }

  std::shared_ptr<const Image> decode(const Json& image, const std::string& uri, const std::string& name) {
    if (images_.size() > kMaxMeshTextures) return nullptr;
    const std::string data = bytes_of_data_uri(uri);
    const Result<std::string_view> bytes =
        uri.empty() ? document_.view(member(&image, "bufferView")) : Result<std::string_view>(std::string_view(data));
    Result<std::shared_ptr<const Image>> read =
        bytes ? image_from_bytes(*bytes, name) : Result<std::shared_ptr<const Image>>(Error{bytes.error()});
    if (read) return *read;
    const auto [text, fix] = split_fix(read.error(), "Fix the image.");
    look_->report(Severity::warning, "texture",
                  fmt::format("texture '{}' {}; its surfaces are drawn without it", name, text), fix);
    return nullptr;
  }

  Document& document_;
  const Json& json_;
  SoupLook* look_;
  SoupObjects* objects_;
  std::uint32_t object_ = 0;
  MeshSoup soup_;
  std::size_t work_ = 0;
  std::map<const Json*, std::uint32_t> materials_;
  std::map<const Json*, std::shared_ptr<const Image>> images_;
};

}  // namespace

}  // namespace limber::model::gltf

namespace limber::model {

Result<MeshSoup> soup_from_gltf(std::string_view bytes, SoupLook* look, SoupObjects* objects) {
  const Result<std::unique_ptr<gltf::Document>> document = gltf::Document::parse(bytes, look ? look->files() : nullptr);
  if (!document) return Error{document.error()};
  return gltf::Reader(**document, look, objects).read();
}

}  // namespace limber::model
