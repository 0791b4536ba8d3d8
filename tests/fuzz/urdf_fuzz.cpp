// Fuzzes the URDF importer. Checks that it returns a consistent body or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/body_checks.h"
#include "model/urdf/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::model::MeshLibrary meshes;
  limber::model::ImportOptions options;
  options.keep_fixed = size % 2 == 1;
  if (size % 3 > 0) options.fixed_base = size % 3 == 1;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto model = limber::model::import_urdf_text(text, "/nonexistent/fuzz.urdf", options, meshes);
  if (!model) {
    limber::must(model.error().find("fuzz.urdf") != std::string::npos);
    return 0;
  }
  limber::check_body(**model);
  return 0;
}
