// Fuzzes the MJCF importer. Checks that it returns a consistent body or an error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/body_checks.h"
#include "model/mjcf/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::model::MeshLibrary meshes;
  limber::model::ImportOptions options;
  options.keep_fixed = size % 2 == 1;
  if (size % 3 > 0) options.fixed_base = size % 3 == 1;
  if (size % 5 == 0) options.root = "world";
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto model = limber::model::import_mjcf_text(text, "/nonexistent/fuzz.xml", options, meshes);
  if (!model) {
    limber::must(model.error().find("fuzz.xml") != std::string::npos);
    return 0;
  }
  limber::check_body(**model);
  return 0;
}
