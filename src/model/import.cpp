// Chooses the importer by the root element.
#include "model/import.h"

#include "model/mjcf/import.h"
#include "model/urdf/import.h"
#include "model/xml_text.h"

namespace limber::model {

Result<std::shared_ptr<const BodyModel>> import_model_text(std::string_view text, const std::string& path,
                                                           const ImportOptions& options, MeshLibrary& meshes) {
  const std::string_view root = root_element_name(text);
  if (root == "mujoco" || root == "mujocoinclude") return import_mjcf_text(text, path, options, meshes);
  return import_urdf_text(text, path, options, meshes);
}

Result<std::shared_ptr<const BodyModel>> import_model(const std::string& path, const ImportOptions& options,
                                                      MeshLibrary& meshes) {
  const Result<std::string> bytes = read_whole_file(path, kMaxUrdfBytes);
  if (!bytes) return Error{bytes.error()};
  return import_model_text(*bytes, path, options, meshes);
}

Result<std::shared_ptr<const BodyModel>> import_model(const std::string& path, const ImportOptions& options) {
  MeshLibrary meshes;
  return import_model(path, options, meshes);
}

}  // namespace limber::model
