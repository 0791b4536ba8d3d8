// C API: surfaces that static parts collide with: heightfields and meshes.
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/heightfield.h"
#include "model/mesh/surface.h"
#include "script/api/script_context.h"
#include "sim/shapes/shape_list.h"

namespace limber::script::calls {

namespace {

std::int32_t add_surface(ScriptContext& c, std::string_view name, Result<model::ShapeModel> model) {
  if (!model) return c.reject(fmt::format("shape '{}': {}", printable(name), model.error()));
  const Result<sim::Shape*> shape = c.world->shapes().add(std::string(name), std::move(*model));
  return shape ? c.set_id((*shape)->id()) : c.reject(shape.error());
}

// True if the call is rejected: callbacks can't read files, and a surface takes too long there.
bool is_rejected(ScriptContext& c, std::string_view name) {
  if (is_full(c)) return true;
  if (c.answer.top_level != 0) return false;
  c.reject(fmt::format("shape '{}': create heightfields and meshes at the top level of the scene, not in a callback",
                       printable(name)));
  return true;
}

}  // namespace

std::int32_t add_heightfield(void* c, const char* name, std::int32_t length, double size_x, double size_y,
                             std::int32_t columns, std::int32_t rows, const double* heights) {
  ScriptContext& context = context_of(c);
  if (is_rejected(context, text_of(name, length))) return kRejected;
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const model::Heightfield field{columns, rows, size_x, size_y, {heights, count}};
  return add_surface(context, text_of(name, length),
                     model::heightfield_shape(field, std::string(text_of(name, length))));
}

std::int32_t add_heightfield_image(void* c, const char* name, std::int32_t length, double size_x, double size_y,
                                   const char* file, std::int32_t file_length, double height) {
  ScriptContext& context = context_of(c);
  if (is_rejected(context, text_of(name, length))) return kRejected;
  const Result<std::string> path = context.sources->find(context.files, text_of(file, file_length));
  if (!path) return context.reject(path.error());
  const Result<std::shared_ptr<const model::Image>> image = context.sources->image(*path);
  if (!image) return context.reject(image.error());
  std::vector<double> heights = model::heights_of(**image);
  for (double& each : heights) each *= height;
  const model::Heightfield field{(*image)->width, (*image)->height, size_x, size_y, heights};
  return add_surface(context, text_of(name, length),
                     model::heightfield_shape(field, std::string(text_of(name, length))));
}

std::int32_t add_mesh_surface(void* c, const char* name, std::int32_t length, const char* file,
                              std::int32_t file_length, double sx, double sy, double sz) {
  ScriptContext& context = context_of(c);
  if (is_rejected(context, text_of(name, length))) return kRejected;
  const Result<std::string> path = context.sources->find(context.files, text_of(file, file_length));
  if (!path) return context.reject(path.error());
  const Result<std::shared_ptr<const model::MeshModel>> mesh = context.sources->mesh(*path, Vec3(sx, sy, sz));
  if (!mesh) return context.reject(mesh.error());
  return add_surface(context, text_of(name, length), model::surface_shape(*mesh));
}

}  // namespace limber::script::calls
