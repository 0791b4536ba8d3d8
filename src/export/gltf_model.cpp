// Node hierarchy: the scene's root, which rotates Z up to Y up; the bodies; their links as a tree, each with a mesh.
// tinygltf writes the JSON text. The buffer is not passed to tinygltf, because it would be copied twice.
#include "export/gltf_model.h"

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include "export/names.h"

namespace limber::exporter {

namespace {

constexpr std::size_t kFloatBytes = sizeof(float);

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

class ModelBuilder {
 public:
  ModelBuilder(const GltfTracks& tracks, GltfModel& out) : tracks_(tracks), out_(out) {}

  tinygltf::Model build(const std::string& name) {
    model_.asset.version = "2.0";
    model_.asset.generator = "Limber";
    tinygltf::Node root;
    root.name = names_.unique("limber");
    root.rotation = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    model_.nodes.push_back(root);
    animation_.name = name;
    if (!tracks_.times().empty()) times_view_ = add_view(bytes_of(tracks_.times()), 0);
    for (const GltfTrack& track : tracks_.tracks()) add_track(track);
    if (!animation_.channels.empty()) model_.animations.push_back(std::move(animation_));
    tinygltf::Scene scene;
    scene.nodes = {0};
    model_.scenes.push_back(std::move(scene));
    model_.defaultScene = 0;
    return std::move(model_);
  }

 private:
  // the size of every piece is a multiple of 4 bytes, so that all pieces are aligned as glTF requires
  int add_view(std::string_view bytes, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = out_.bytes;
    view.byteLength = bytes.size();
    view.target = target;
    model_.bufferViews.push_back(view);
    out_.pieces.push_back(bytes);
    out_.bytes += bytes.size();
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  int add_accessor(int view, int type, int component, std::size_t count, std::size_t offset = 0) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.type = type;
    accessor.componentType = component;
    accessor.count = count;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int add_numbers(std::string_view bytes, int type, std::size_t count) {
    return add_accessor(add_view(bytes, 0), type, TINYGLTF_COMPONENT_TYPE_FLOAT, count);
  }

  // accessor for the times of consecutive frames
  int times_accessor(std::size_t first, std::size_t count) {
    const auto [known, is_new] = time_accessors_.try_emplace({first, count}, 0);
    if (!is_new) return known->second;
    known->second =
        add_accessor(times_view_, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, count, first * kFloatBytes);
    model_.accessors.back().minValues = {tracks_.times()[first]};
    model_.accessors.back().maxValues = {tracks_.times()[first + count - 1]};
    return known->second;
  }

  void add_channel(int node, const char* path, int times, int values, const char* interpolation) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times;
    sampler.output = values;
    sampler.interpolation = interpolation;
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation_.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation_.samplers.push_back(std::move(sampler));
    animation_.channels.push_back(std::move(channel));
  }

  int add_node(tinygltf::Node node, int parent) {
    const int number = static_cast<int>(model_.nodes.size());
    model_.nodes.push_back(std::move(node));
    model_.nodes[static_cast<std::size_t>(parent)].children.push_back(number);
    return number;
  }

  void add_track(const GltfTrack& track) {
    tinygltf::Node body_node;
    body_node.name = names_.unique(track.body.name);
    const int body = add_node(std::move(body_node), 0);
    if (track.presence_changes.size() > 1 || track.first > 0) add_visibility(track, body);
    std::vector<int> nodes(track.links.size(), body);
    for (const std::size_t i : link_order(track.body).links) {
      const MotionLink& link = track.body.links[i];
      const GltfLinkKeys& keys = track.links[i];
      tinygltf::Node node;
      node.name = names_.unique(track.body.name + "." + link.name);
      node.mesh = mesh_index(link);
      node.translation.assign(keys.positions.begin(), keys.positions.begin() + 3);
      node.rotation.assign(keys.rotations.begin(), keys.rotations.begin() + 4);
      nodes[i] = add_node(std::move(node), link.parent < 0 ? body : nodes[static_cast<std::size_t>(link.parent)]);
      if (keys.at_rest) continue;
      const std::size_t count = track.keys();
      const int times = times_accessor(track.first, count);
      const int positions =
          add_numbers(bytes_of(keys.positions).substr(0, 3 * kFloatBytes * count), TINYGLTF_TYPE_VEC3, count);
      const int rotations =
          add_numbers(bytes_of(keys.rotations).substr(0, 4 * kFloatBytes * count), TINYGLTF_TYPE_VEC4, count);
      add_channel(nodes[i], "translation", times, positions, "LINEAR");
      add_channel(nodes[i], "rotation", times, rotations, "LINEAR");
    }
  }

  // animates the presence of a body as scale 1 or 0; viewers without animation show the body
  void add_visibility(const GltfTrack& track, int body) {
    std::vector<float>& times = out_.own_data.emplace_back();
    std::vector<float>& sizes = out_.own_data.emplace_back();
    const auto add = [&](float time, float size) {
      times.push_back(time);
      sizes.insert(sizes.end(), 3, size);
    };
    if (track.first > 0) add(0, 0);
    float size = 0;
    for (const std::size_t frame : track.presence_changes) add(tracks_.times()[frame], size = 1 - size);
    const int input = add_numbers(bytes_of(times), TINYGLTF_TYPE_SCALAR, times.size());
    model_.accessors.back().minValues = {times.front()};
    model_.accessors.back().maxValues = {times.back()};
    add_channel(body, "scale", input, add_numbers(bytes_of(sizes), TINYGLTF_TYPE_VEC3, times.size()), "STEP");
  }

  int mesh_index(const MotionLink& link) {
    if (link.surfaces == nullptr || link.surfaces->empty()) return -1;
    const auto [known, is_new] = meshes_.try_emplace(link.surfaces.get(), static_cast<int>(model_.meshes.size()));
    if (!is_new) return known->second;
    tinygltf::Mesh mesh;
    mesh.name = link.name;
    for (const Surface& surface : *link.surfaces) {
      tinygltf::Primitive primitive;
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      primitive.material = material_index(surface);
      primitive.attributes["POSITION"] = add_points(surface);
      primitive.attributes["NORMAL"] = add_vertices(surface.normals);
      if (!surface.colors.empty()) primitive.attributes["COLOR_0"] = add_vertices(surface.colors);
      const int view = add_view(bytes_of(surface.triangles), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
      primitive.indices =
          add_accessor(view, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, surface.triangles.size());
      mesh.primitives.push_back(std::move(primitive));
    }
    model_.meshes.push_back(std::move(mesh));
    return known->second;
  }

  int add_vertices(const std::vector<std::array<float, 3>>& vectors) {
    return add_accessor(add_view(bytes_of(vectors), TINYGLTF_TARGET_ARRAY_BUFFER), TINYGLTF_TYPE_VEC3,
                        TINYGLTF_COMPONENT_TYPE_FLOAT, vectors.size());
  }

  int add_points(const Surface& surface) {
    const int accessor = add_vertices(surface.points);
    std::vector<double> low(surface.points[0].begin(), surface.points[0].end());
    std::vector<double> high = low;
    for (const std::array<float, 3>& p : surface.points) {
      for (std::size_t i = 0; i < 3; i++) {
        low[i] = std::min<double>(low[i], p[i]);
        high[i] = std::max<double>(high[i], p[i]);
      }
    }
    model_.accessors.back().minValues = std::move(low);
    model_.accessors.back().maxValues = std::move(high);
    return accessor;
  }

  int material_index(const Surface& surface) {
    const Vec3& c = surface.color;
    const auto [known, is_new] =
        materials_.try_emplace({c.x, c.y, c.z, surface.alpha}, static_cast<int>(model_.materials.size()));
    if (!is_new) return known->second;
    tinygltf::Material material;
    material.name = "material-" + std::to_string(known->second + 1);
    material.pbrMetallicRoughness.baseColorFactor = {c.x, c.y, c.z, surface.alpha};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.5;
    if (surface.alpha < 1) material.alphaMode = "BLEND";
    model_.materials.push_back(std::move(material));
    return known->second;
  }

  const GltfTracks& tracks_;
  GltfModel& out_;
  tinygltf::Model model_;
  tinygltf::Animation animation_;
  UniqueNames names_;
  int times_view_ = -1;
  std::map<std::pair<std::size_t, std::size_t>, int> time_accessors_;
  std::map<const Surfaces*, int> meshes_;
  std::map<std::tuple<double, double, double, double>, int> materials_;
};

}  // namespace

Result<GltfModel> gltf_model(const GltfTracks& tracks, const std::string& name, const std::string& uri) {
  GltfModel out;
  try {
    const tinygltf::Model model = ModelBuilder(tracks, out).build(name);
    if (out.bytes > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
      return Error{"meshes and keys take more than 2 GB, more than most programs read. Choose bodies with --body"};
    std::ostringstream text;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, false, false);
    nlohmann::json json = nlohmann::json::parse(text.str());
    if (out.bytes > 0) {
      nlohmann::json buffer = {{"byteLength", out.bytes}};
      if (!uri.empty()) buffer["uri"] = uri;
      json["buffers"] = nlohmann::json::array({buffer});
    }
    out.json = json.dump();
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
  return out;
}

}  // namespace limber::exporter
