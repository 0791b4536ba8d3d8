// Parts of a glTF file: JSON, buffers, accessors. Own code instead of tinygltf, which reads any file that is named,
// without limits.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/gltf.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"

namespace limber::model::gltf {

/// The type of an accessor's numbers.
struct Component {
  std::size_t bytes;
  bool negative, real;
  double max;  ///< Of a normalized integer.
};

namespace {

constexpr std::size_t kMaxJsonBytes = 32u << 20;
constexpr std::uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

const Error kDamaged{"is not a glTF file, or is damaged. Export it again."};

std::uint32_t little_endian_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// A whole number of a member, 0 if it is absent; empty if it is invalid or above `max`.
std::optional<std::size_t> whole(const Json& object, const char* key, std::size_t max) {
  const double value = number(object, key, 0);
  if (!(value >= 0 && value <= static_cast<double>(max)) || value != std::floor(value)) return {};
  return static_cast<std::size_t>(value);
}

std::optional<Component> component_of(double type) {
  constexpr std::array<std::optional<Component>, 7> kComponents{Component{1, true, false, 127},
                                                                Component{1, false, false, 255},
                                                                Component{2, true, false, 32767},
                                                                Component{2, false, false, 65535},
                                                                std::nullopt,
                                                                Component{4, false, false, 4294967295.0},
                                                                Component{4, true, true, 1}};
  constexpr double kFirst = 5120;
  const double at = type - kFirst;
  if (!(at >= 0 && at < 7) || at != std::floor(at)) return {};
  return kComponents[static_cast<std::size_t>(at)];
}

double decode(const char* from, const Component& c) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, from, c.bytes);
  if (c.real) return static_cast<double>(std::bit_cast<float>(bits));
  if (!c.negative) return bits;
  const unsigned unused = 32 - 8 * static_cast<unsigned>(c.bytes);
  return static_cast<std::int32_t>(bits << unused) >> unused;
}

}  // namespace

const Json* member(const Json* object, const char* key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() ? nullptr : &*found;
}

const Json* element(const Json& document, const char* array, const Json* index) {
  const Json* const list = member(&document, array);
  if (list == nullptr || !list->is_array() || index == nullptr || !index->is_number_unsigned()) return nullptr;
  const auto at = index->get<std::uint64_t>();
  return at < list->size() ? &(*list)[at] : nullptr;
}

double number(const Json& object, const char* key, double fallback) {
  const Json* const found = member(&object, key);
  const double value = found != nullptr && found->is_number() ? found->get<double>() : fallback;
  return std::isfinite(value) ? value : fallback;
}

std::string text(const Json& object, const char* key) {
  const Json* const found = member(&object, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

std::string bytes_of_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) return {};
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : uri.substr(comma + 1)) {
    if (c == '=') break;
    const int value = values[static_cast<unsigned char>(c)];
    if (value < 0) return {};
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 255);
  }
  return out;
}

namespace {

// The chunks of a GLB file; a text file is all JSON. False if a chunk ends beyond the file.
bool split_chunks(std::string_view bytes, std::string_view& json, std::string_view& binary) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  json = bytes;
  if (bytes.size() < kHeader + kChunkHeader || little_endian_at(bytes, 0) != kMagic) return true;
  json = {};
  for (std::size_t at = kHeader; at + kChunkHeader <= bytes.size();) {
    const std::size_t length = little_endian_at(bytes, at);
    if (length > bytes.size() - at - kChunkHeader) return false;
    const std::string_view data = bytes.substr(at + kChunkHeader, length);
    if (little_endian_at(bytes, at + 4) == kJsonChunk && json.empty()) json = data;
    if (little_endian_at(bytes, at + 4) == kBinaryChunk && binary.empty()) binary = data;
    at += kChunkHeader + length;
  }
  return true;
}

// The name of a required extension that compresses meshes; empty: none.
std::string required_compression(const Json& document) {
  const Json* const required = member(&document, "extensionsRequired");
  if (required == nullptr || !required->is_array()) return {};
  for (const Json& name : *required) {
    std::string extension = name.is_string() ? name.get<std::string>() : std::string();
    if (extension.find("compression") != std::string::npos) return extension;
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<Document>> Document::parse(std::string_view bytes, LookFiles* files) {
  auto document = std::make_unique<Document>();
  document->files_ = files;
  std::string_view json;
  if (!split_chunks(bytes, json, document->glb_)) return kDamaged;
  if (json.size() > kMaxJsonBytes)
    return Error{
        fmt::format("has {} bytes of JSON; at most {} are read. Export it as GLB.", json.size(), kMaxJsonBytes)};
  document->json_ = Json::parse(json, nullptr, false);
  const Json* const asset = member(&document->json_, "asset");
  if (document->json_.is_discarded() || asset == nullptr) return kDamaged;
  if (!text(*asset, "version").starts_with("2."))
    return Error{fmt::format("has glTF version '{}', not 2. Export it again.", printable(text(*asset, "version")))};
  if (const std::string name = required_compression(document->json_); !name.empty())
    return Error{fmt::format("is compressed with {}. Export it without compression.", printable(name))};
  return document;
}

Result<std::string_view> Document::buffer(const Json* index) {
  const Json* const found = element(json_, "buffers", index);
  if (found == nullptr) return Error{"refers to a buffer that doesn't exist. Export it again."};
  const auto at = index->get<std::size_t>();
  const std::string uri = text(*found, "uri");
  if (uri.empty()) return glb_;
  const auto [known, is_new] = buffers_.try_emplace(at);
  if (!is_new) return std::string_view(known->second);
  if (uri.starts_with("data:")) {
    known->second = bytes_of_data_uri(uri);
  } else if (files_ == nullptr) {
    return Error{fmt::format("buffer '{}' not found. Export it as GLB.", printable(uri))};
  } else {
    Result<std::string> bytes = files_->read(uri, ".bin", kMaxMeshBytes);
    if (!bytes) return Error{fmt::format("buffer {}", bytes.error())};
    known->second = std::move(*bytes);
  }
  buffer_bytes_ += known->second.size();
  if (buffer_bytes_ > 2 * kMaxMeshBytes) return Error{"has too large buffers. Simplify it."};
  return std::string_view(known->second);
}

Result<std::string_view> Document::view(const Json* index) {
  const Json* const found = element(json_, "bufferViews", index);
  if (found == nullptr) return Error{"refers to a buffer view that doesn't exist. Export it again."};
  const Result<std::string_view> bytes = buffer(member(found, "buffer"));
  if (!bytes) return bytes;
  const auto offset = whole(*found, "byteOffset", bytes->size());
  const auto length = whole(*found, "byteLength", bytes->size());
  if (!offset || !length || *length > bytes->size() - *offset)
    return Error{"has a buffer view beyond its buffer. Export it again."};
  return bytes->substr(*offset, *length);
}

/// Where the numbers of an accessor are.
struct Document::Layout {
  std::string_view bytes;
  Component component;
  std::size_t offset = 0, step = 0, count = 0;
};

Result<Document::Layout> Document::layout_of(const Json& accessor, std::size_t components, std::size_t max_count) {
  if (accessor.contains("sparse")) return Error{"has sparse accessors, which are not supported. Export it again."};
  const Result<std::string_view> bytes = view(member(&accessor, "bufferView"));
  if (!bytes) return Error{bytes.error()};
  constexpr std::array<std::string_view, 5> kKinds{"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto width =
      static_cast<std::size_t>(std::find(kKinds.begin(), kKinds.end(), text(accessor, "type")) - kKinds.begin());
  const auto component = component_of(number(accessor, "componentType", 0));
  const auto count = whole(accessor, "count", max_count);
  const auto offset = whole(accessor, "byteOffset", bytes->size());
  if (!count) return too_many_triangles();
  if (!component || width < components || width >= kKinds.size() || !offset) return kDamaged;
  constexpr std::size_t kMaxStride = 252;
  const std::size_t tight = width * component->bytes;
  const auto stride = whole(*element(json_, "bufferViews", member(&accessor, "bufferView")), "byteStride", kMaxStride);
  const std::size_t step = stride && *stride >= tight ? *stride : tight;
  if (*count > 0 && *offset + (*count - 1) * step + tight > bytes->size())
    return Error{"has an accessor beyond its buffer view. Export it again."};
  return Layout{*bytes, *component, *offset, step, *count};
}

Result<std::vector<double>> Document::numbers(const Json* index, std::size_t components, std::size_t max_count) {
  const Json* const accessor = element(json_, "accessors", index);
  if (accessor == nullptr) return Error{"refers to an accessor that doesn't exist. Export it again."};
  const Result<Layout> layout = layout_of(*accessor, components, max_count);
  if (!layout) return Error{layout.error()};
  const Json* const normalized = member(accessor, "normalized");
  const bool fraction = normalized != nullptr && normalized->is_boolean() && normalized->get<bool>();
  std::vector<double> out;
  out.reserve(layout->count * components);
  for (std::size_t i = 0; i < layout->count; ++i) {
    for (std::size_t k = 0; k < components; ++k) {
      const std::size_t at = layout->offset + i * layout->step + k * layout->component.bytes;
      const double value = decode(layout->bytes.data() + at, layout->component);
      if (!std::isfinite(value)) return Error{"has a number that is not finite. Export it again."};
      out.push_back(fraction ? value / layout->component.max : value);
    }
  }
  return out;
}

}  // namespace limber::model::gltf
