// glTF reader: the document with its buffers, and the numbers of accessors. Internal to the module: only gltf*.cpp
// includes it.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "model/look/soup_look.h"

namespace limber::model::gltf {

using Json = nlohmann::json;

/// The element of an array of the document, such as "meshes"; null if it doesn't exist. [any]
const Json* element(const Json& document, const char* array, const Json* index);
/// A number of an object; `fallback` if it is absent or no finite number. [any]
double number(const Json& object, const char* key, double fallback);
/// The text of an object's member; empty if it is absent. [any]
std::string text(const Json& object, const char* key);
/// A member of an object; null if it is absent or the object isn't one. [any]
const Json* member(const Json* object, const char* key);

/// The bytes of a data URI in base64; empty if it is none, or invalid. [any]
std::string bytes_of_data_uri(std::string_view uri);

class Document {
 public:
  /// Parses a text or GLB file, which must exist as long as the document.
  static Result<std::unique_ptr<Document>> parse(std::string_view bytes, LookFiles* files);

  const Json& json() const { return json_; }
  /// The bytes of a buffer view.
  Result<std::string_view> view(const Json* index);
  /// The numbers of an accessor, `components` for each element; normalized integers become fractions. At most
  /// `max_count` elements.
  Result<std::vector<double>> numbers(const Json* index, std::size_t components, std::size_t max_count);

 private:
  struct Layout;
  Result<std::string_view> buffer(const Json* index);
  Result<Layout> layout_of(const Json& accessor, std::size_t components, std::size_t max_count);

  Json json_;
  std::string_view glb_;  // the binary chunk
  LookFiles* files_ = nullptr;
  std::map<std::size_t, std::string> buffers_;  // those of other files and of data URIs
  std::size_t buffer_bytes_ = 0;
};

}  // namespace limber::model::gltf
