// The passes of a frame: shadow map, ground map, mirrored scene, floor, opaque shapes, background, transparent shapes,
// beams of light, debug overlay.
#include "ui/render/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include <span>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace limber::render {

/// The settings of a quality level.
struct Renderer::QualitySettings {
  int samples;  // per pixel
  int shadow_taps;
  int contact_taps;
  int dither;
  int shadow_map_size;
  int ground_map_size;
  int detail_bias;
  bool mirror;
};

namespace {

constexpr float kMinFloorNormalZ = 0.9999F;  // z of the normal above which a plane is horizontal, i.e. a floor

// OpenGL takes offsets in a buffer as pointers: NOLINTNEXTLINE(performance-no-int-to-ptr)
const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

void bind_instance_attributes(std::size_t first) {
  constexpr std::array<std::size_t, 5> kOffsets = {offsetof(Instance, position), offsetof(Instance, rotation),
                                                   offsetof(Instance, extent), offsetof(Instance, diffuse),
                                                   offsetof(Instance, ambient)};
  for (std::size_t i = 0; i < kOffsets.size(); i++) {
    glVertexAttribPointer(static_cast<GLuint>(2 + i), 4, GL_FLOAT, GL_FALSE, sizeof(Instance),
                          offset(first * sizeof(Instance) + kOffsets[i]));
  }
}

}  // namespace

Renderer::Renderer(GlApi api, std::string shader_folder, const QualitySettings& settings, std::string defines)
    : api_(gl_api_info(api)),
      settings_(settings),
      shaders_(api, std::move(shader_folder), std::move(defines)),
      instances_(GlBuffer::make()),
      uniforms_(GlBuffer::make()),
      no_attributes_(GlVertexArray::make()),
      shadow_map_(make_depth(settings.shadow_map_size, true)),
      ground_map_(make_depth(settings.ground_map_size, false)),
      target_(api),
      output_(api),
      overlay_buffer_(GlBuffer::make()),
      overlay_array_(GlVertexArray::make()) {
  GLint texture = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size_);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  max_size_ = std::min({max_size_, texture, 16384});
}

Result<std::unique_ptr<Renderer>> Renderer::make(GlApi api, const std::string& shader_folder, Quality quality) {
  static const std::array<QualitySettings, 3> settings_by_quality = {{{.samples = 0,
                                                                       .shadow_taps = 1,
                                                                       .contact_taps = 0,
                                                                       .dither = 0,
                                                                       .shadow_map_size = 1024,
                                                                       .ground_map_size = 8,
                                                                       .detail_bias = 1,
                                                                       .mirror = false},
                                                                      {.samples = 2,
                                                                       .shadow_taps = 6,
                                                                       .contact_taps = 6,
                                                                       .dither = 1,
                                                                       .shadow_map_size = 1024,
                                                                       .ground_map_size = 256,
                                                                       .detail_bias = 0,
                                                                       .mirror = true},
                                                                      {.samples = 4,
                                                                       .shadow_taps = 14,
                                                                       .contact_taps = 12,
                                                                       .dither = 1,
                                                                       .shadow_map_size = 2048,
                                                                       .ground_map_size = 512,
                                                                       .detail_bias = 0,
                                                                       .mirror = true}}};
  for (const char* extension : {"GL_ARB_explicit_attrib_location", "GL_ARB_instanced_arrays"}) {
    if (api == GlApi::gl31 && !epoxy_has_gl_extension(extension))
      return Error{fmt::format("{} lacks {}. Update the graphics driver, or draw in software: LIBGL_ALWAYS_SOFTWARE=1",
                               gl_driver(), extension)};
  }
  const QualitySettings& settings = settings_by_quality[static_cast<std::size_t>(quality)];
  std::string defines = fmt::format("#define SHADOW_TAPS {}\n#define CONTACT_TAPS {}\n#define DITHER {}\n",
                                    settings.shadow_taps, settings.contact_taps, settings.dither);
  std::unique_ptr<Renderer> renderer(new Renderer(api, shader_folder, settings, std::move(defines)));
  if (Result<void> started = renderer->shaders_.build_all(); !started) return Error{started.error()};
  return renderer;
}

Renderer::DepthMap Renderer::make_depth(int side, bool compares) const {
  DepthMap map{GlTexture::make(), GlFramebuffer::make()};
  glBindTexture(GL_TEXTURE_2D, *map.texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, side, side, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  const GLint filter = compares || api_.depth_filter ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (compares) glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glBindFramebuffer(GL_FRAMEBUFFER, *map.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *map.texture, 0);
  const GLenum none = GL_NONE;
  glDrawBuffers(1, &none);
  glReadBuffer(GL_NONE);
  return map;
}

namespace {

void set_vertex_attributes(const MeshVertex*) {
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), offset(offsetof(MeshVertex, corner)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(MeshVertex), offset(offsetof(MeshVertex, normal)));
}

void set_vertex_attributes(const ColoredVertex*) {
  constexpr GLsizei kSize = sizeof(ColoredVertex);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kSize, offset(offsetof(ColoredVertex, corner)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, kSize, offset(offsetof(ColoredVertex, normal)));
  constexpr GLuint kFirst = 7;  // after the attributes of instances
  glVertexAttribPointer(kFirst, 2, GL_FLOAT, GL_FALSE, kSize, offset(offsetof(ColoredVertex, texcoord)));
  glVertexAttribPointer(kFirst + 1, 4, GL_UNSIGNED_BYTE, GL_TRUE, kSize, offset(offsetof(ColoredVertex, color)));
  glVertexAttribPointer(kFirst + 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kSize, offset(offsetof(ColoredVertex, emission)));
  for (GLuint i = kFirst; i < kFirst + 3; i++) glEnableVertexAttribArray(i);
}

}  // namespace

template <class Vertex>
Renderer::GpuMesh Renderer::make_mesh(const std::vector<Vertex>& triangles) {
  const IndexedVertices<Vertex> indexed_mesh = with_shared_vertices(triangles);
  GpuMesh gpu_mesh = {GlVertexArray::make(), GlBuffer::make(), GlBuffer::make(),
                      static_cast<GLsizei>(indexed_mesh.indices.size())};
  glBindVertexArray(*gpu_mesh.array);
  const auto fill = [](GLenum target, const GlBuffer& buffer, const auto& values) {
    glBindBuffer(target, *buffer);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof values[0]), values.data(), GL_STATIC_DRAW);
  };
  fill(GL_ELEMENT_ARRAY_BUFFER, gpu_mesh.indices, indexed_mesh.indices);
  fill(GL_ARRAY_BUFFER, gpu_mesh.vertices, indexed_mesh.vertices);
  set_vertex_attributes(static_cast<const Vertex*>(nullptr));
  for (GLuint i = 0; i < 7; i++) {
    glEnableVertexAttribArray(i);
    if (i >= 2) glVertexAttribDivisor(i, 1);
  }
  return gpu_mesh;
}

const Renderer::GpuMesh& Renderer::mesh(const MeshKey& key, int detail) {
  const auto [found, fresh] = meshes_.try_emplace({key, detail});
  if (!fresh) return found->second;
  if (key.coloring == MeshColoring::plain) {
    found->second = make_mesh(key.model != nullptr ? model_mesh(*key.model, detail) : primitive_mesh(key.kind, detail));
  } else {
    make_colored_meshes(key, detail);
  }
  return found->second;
}

// builds all parts at once, because they share the computation of normals
void Renderer::make_colored_meshes(const MeshKey& key, int detail) {
  model::ShapeModel shape;
  shape.kind = key.kind;
  if (key.model != nullptr) shape.mesh = draw_list_.models().at(key.model);
  const auto image = draw_list_.images().find(key.texture);
  if (key.coloring == MeshColoring::textured && image != draw_list_.images().end()) shape.texture = image->second;
  const std::vector<MeshPart> parts = mesh_parts(shape);
  const std::vector<ColoredVertices> meshes = colored_meshes(shape, detail);
  MeshKey part_key = key;
  for (std::size_t i = 0; i < meshes.size(); i++) {
    part_key.part = static_cast<std::uint32_t>(i);
    part_key.texture = parts[i].texture.get();
    meshes_[{part_key, detail}] = make_mesh(meshes[i]);
  }
}

// frees meshes and textures from files that the scene no longer uses
void Renderer::release_unused_meshes() {
  if (meshes_scene_ == draw_list_.scene()) return;
  meshes_scene_ = draw_list_.scene();
  const auto unused = [this](const model::Image* image) {
    return image != nullptr && !draw_list_.images().contains(image);
  };
  std::erase_if(meshes_, [&](const auto& entry) {
    const MeshKey& key = entry.first.first;
    return (key.model != nullptr && !draw_list_.models().contains(key.model)) || unused(key.texture);
  });
  std::erase_if(textures_, [&](const auto& entry) { return unused(entry.first); });
}

// begins a pass that draws shapes in color
void Renderer::begin_shapes(bool mirrored) {
  const bool discards = mirrored && !api_.clip_distance;
  shape_programs_ = {shaders_.program(discards ? "mirrored" : "shape"),
                     shaders_.program(discards ? "mirrored_colored" : "colored")};
  glUseProgram(shape_programs_[0]);
  colored_bound_ = false;
  bound_texture_ = 0;
}

// binds the program and the texture for a mesh, if they aren't bound yet
void Renderer::use_coloring(const MeshKey& key) {
  const bool colored = key.coloring != MeshColoring::plain;
  if (colored != colored_bound_) glUseProgram(shape_programs_[colored ? 1 : 0]);
  colored_bound_ = colored;
  if (!colored) return;
  glActiveTexture(GL_TEXTURE2);
  GlTexture* texture = &white_;
  if (key.texture != nullptr) {
    texture = &textures_[key.texture];
    if (!*texture) *texture = make_texture(*key.texture, max_size_);
  } else if (!white_) {
    white_ = make_texture({"", 1, 1, 0, {255, 255, 255, 255}}, max_size_);
  }
  if (bound_texture_ != **texture) glBindTexture(GL_TEXTURE_2D, **texture);
  bound_texture_ = **texture;
  glActiveTexture(GL_TEXTURE0);
}

void Renderer::upload(const FrameUniforms& frame) {
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, *uniforms_);
  glBufferData(GL_UNIFORM_BUFFER, sizeof frame, &frame, GL_STREAM_DRAW);
}

// a depth pass draws only batches that cast shadows, coarser by one level of detail
void Renderer::draw_batches(const std::vector<Batch>& batches, Pass pass) {
  for (const Batch& batch : batches) {
    if (pass == Pass::depth && !batch.casts_shadow) continue;
    const int detail = batch.detail + (pass == Pass::depth ? 1 : 0);
    const GpuMesh& gpu = mesh(batch.mesh, std::min(detail, kDetailLevels - 1));
    if (pass == Pass::color) use_coloring(batch.mesh);
    glBindVertexArray(*gpu.array);
    glBindBuffer(GL_ARRAY_BUFFER, *instances_);
    bind_instance_attributes(batch.first);
    glDrawElementsInstanced(GL_TRIANGLES, gpu.count, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(batch.count));
  }
}

// `clamp_depth`: geometry in front of the near plane is clamped to it instead of clipped
void Renderer::draw_depth(const DepthMap& map, int side, const glm::mat4& clip, bool clamp_depth) {
  FrameUniforms frame{};
  frame.view_proj = clip;
  upload(frame);
  glBindFramebuffer(GL_FRAMEBUFFER, *map.framebuffer);
  glViewport(0, 0, side, side);
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(shaders_.program(clamp_depth && !api_.depth_clamp ? "ground" : "depth"));
  if (clamp_depth) {
    if (api_.depth_clamp) glEnable(GL_DEPTH_CLAMP);
    glDisable(GL_CULL_FACE);
  } else {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5F, 2.0F);
  }
  draw_batches(draw_list_.opaque(), Pass::depth);
  draw_batches(draw_list_.transparent(), Pass::depth);
  if (clamp_depth && api_.depth_clamp) glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glEnable(GL_CULL_FACE);
}

void Renderer::draw_sky() {
  glDepthMask(GL_FALSE);
  glUseProgram(shaders_.program("sky"));
  glBindVertexArray(*no_attributes_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

// draws the scene mirrored at the floor, as seen in a reflection; the floor is blended over it
void Renderer::draw_mirrored(const Lighting& lighting) {
  const float floor = lighting.frame.floor_height;
  FrameUniforms frame = lighting.frame;
  glm::mat4 reflection = glm::translate(glm::mat4(1), glm::vec3(0, 0, 2 * floor));
  reflection = glm::scale(reflection, glm::vec3(1, 1, -1));
  frame.view_proj = frame.view_proj * reflection;
  frame.eye.z = 2 * floor - frame.eye.z;
  frame.eye.w = 1;
  upload(frame);
  begin_shapes(true);
  glFrontFace(GL_CW);
  if (api_.clip_distance) glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_BLEND);
  draw_batches(draw_list_.opaque(), Pass::color);
  draw_batches(draw_list_.transparent(), Pass::color);
  glDisable(GL_BLEND);
  if (api_.clip_distance) glDisable(GL_CLIP_DISTANCE0);
  glFrontFace(GL_CCW);
}

void Renderer::draw_plane(const RenderPlane& plane, const Lighting& lighting, bool is_floor) {
  const glm::vec3 n = glm::normalize(plane.normal);
  const glm::vec3 eye(lighting.frame.eye);
  const glm::vec3 below = eye - n * glm::dot(eye - plane.origin, n);
  const glm::vec3 along =
      std::abs(n.z) > kMinFloorNormalZ ? glm::vec3(1, 0, 0) : glm::normalize(glm::cross(glm::vec3(0, 0, 1), n));
  const glm::vec3 across = glm::cross(n, along);
  glUseProgram(shaders_.program("floor"));
  const auto set = [this](const char* name, const glm::vec4& value) {
    glUniform4fv(shaders_.uniform("floor", name), 1, glm::value_ptr(value));
  };
  set("origin", glm::vec4(below, lighting.floor_half_width));
  set("along", glm::vec4(along, is_floor ? 1 : 0));
  set("across", glm::vec4(across, 0));
  set("tint", glm::vec4(plane.tint, plane.alpha));
  const bool opaque = plane.alpha >= 1 && !(is_floor && lighting.has_mirror);
  if (!opaque) glEnable(GL_BLEND);
  glBindVertexArray(*no_attributes_);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_BLEND);
}

// draws the scene's planes; the first horizontal one is the floor; without one, draws a floor at height 0
void Renderer::draw_planes(const Lighting& lighting, const engine::AppearanceSettings& appearance) {
  glDisable(GL_CULL_FACE);
  bool has_floor = false;
  for (const RenderPlane& plane : draw_list_.planes()) {
    const bool horizontal = std::abs(plane.normal.z) > kMinFloorNormalZ;
    draw_plane(plane, lighting, horizontal && !has_floor);
    has_floor = has_floor || horizontal;
  }
  if (!has_floor && appearance.floor && lighting.frame.eye.z > lighting.frame.floor_height)
    draw_plane({{0, 0, 0}, {0, 0, 1}, glm::vec3(1), 1}, lighting, true);
  glEnable(GL_CULL_FACE);
}

// draws the overlay on top in two passes: faint where it is occluded, then fully where it is visible
void Renderer::draw_overlay(const engine::Snapshot& previous, const engine::Snapshot& current, double mix,
                            const RenderTarget& target) {
  constexpr double kReferenceHeight = 720;  // height of a view in which lines are 1.3 pixels wide
  constexpr float kOccludedOpacity = 0.3F;
  if (current.overlay.empty()) return;
  overlay_.update(previous, current, mix, std::max(1.0, 1.3 * target.height() / kReferenceHeight));
  const std::span<const OverlayLine> lines = overlay_.lines();
  glBindVertexArray(*overlay_array_);
  glBindBuffer(GL_ARRAY_BUFFER, *overlay_buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(lines.size_bytes()), lines.data(), GL_STREAM_DRAW);
  constexpr std::array<std::size_t, 3> kOffsets = {offsetof(OverlayLine, from), offsetof(OverlayLine, to),
                                                   offsetof(OverlayLine, color)};
  for (GLuint i = 0; i < kOffsets.size(); i++) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, sizeof(OverlayLine), offset(kOffsets[i]));
    glVertexAttribDivisor(i, 1);
  }
  glUseProgram(shaders_.program("overlay"));
  glUniform4f(shaders_.uniform("overlay", "screen"), static_cast<float>(target.width()),
              static_cast<float>(target.height()), 0, 0);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  const auto pass = [&](GLenum depth, float strength) {
    glDepthFunc(depth);
    glUniform4f(shaders_.uniform("overlay", "strength"), strength, 0, 0, 0);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(lines.size()));
  };
  pass(GL_GREATER, kOccludedOpacity);
  pass(GL_LEQUAL, 1);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
}

void Renderer::upload_instances() {
  const std::vector<Instance>& instances = draw_list_.instances();
  glBindBuffer(GL_ARRAY_BUFFER, *instances_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(Instance)), instances.data(),
               GL_STREAM_DRAW);
}

// draws the shadow map and the ground map, and leaves them bound for the passes that follow
void Renderer::draw_depth_maps(const Lighting& lighting) {
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_CULL_FACE);
  set_srgb_conversion(api_, true);
  draw_depth(shadow_map_, settings_.shadow_map_size, lighting.shadow_clip, false);
  if (settings_.contact_taps > 0) draw_depth(ground_map_, settings_.ground_map_size, lighting.ground_clip, true);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, *ground_map_.texture);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, *shadow_map_.texture);
}

Result<void> Renderer::draw(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, int width,
                            int height, const FreeArea& free_area) {
  return draw_into(target_, previous, current, mix, engine::camera_of(current), width, height, free_area);
}

Result<void> Renderer::draw_from(const engine::Snapshot& current, const engine::CameraSettings& camera, int width,
                                 int height) {
  return draw_into(target_, current, current, 1, camera, width, height, {});
}

Result<void> Renderer::draw_output(const engine::Snapshot& previous, const engine::Snapshot& current, double mix,
                                   int width, int height) {
  return draw_into(output_, previous, current, mix, engine::camera_of(current), width, height, {});
}

Result<void> Renderer::draw_into(RenderTarget& target, const engine::Snapshot& previous,
                                 const engine::Snapshot& current, double mix, const engine::CameraSettings& camera,
                                 int width, int height, const FreeArea& free_area) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  if (width > max_size_ || height > max_size_)
    return Error{fmt::format("an image of {} × {} is too large: {} supports up to {} per side", width, height,
                             gl_driver(), max_size_)};
  if (Result<void> sized = target.resize(width, height, settings_.samples); !sized) return sized;
  const engine::AppearanceSettings appearance = engine::appearance_of(current);
  const CameraMatrices matrices = camera_matrices(camera, width, height, free_area);
  draw_list_.update(previous, current, mix,
                    {matrices.eye, matrices.forward, matrices.focal_pixels, settings_.detail_bias});
  release_unused_meshes();
  SceneBounds bounds{draw_list_.center(), draw_list_.radius(), 0, settings_.shadow_map_size};
  for (const RenderPlane& plane : draw_list_.planes()) {
    if (std::abs(plane.normal.z) <= kMinFloorNormalZ) continue;
    bounds.floor_height = plane.origin.z;
    break;
  }
  Lighting lighting = compute_lighting(appearance, matrices, camera.far, bounds);
  if (!settings_.mirror) {
    lighting.has_mirror = false;
    lighting.frame.floor_color.w = 0;
  }

  upload_instances();
  draw_depth_maps(lighting);
  target.begin();
  upload(lighting.frame);
  // a reflective floor is blended over the mirrored scene, so it comes first; otherwise shapes come first, so that the
  // depth test saves work on the floor
  if (lighting.has_mirror) {
    draw_sky();
    draw_mirrored(lighting);
    upload(lighting.frame);
    draw_planes(lighting, appearance);
  }
  begin_shapes(false);
  draw_batches(draw_list_.opaque(), Pass::color);
  if (!lighting.has_mirror) {
    draw_planes(lighting, appearance);
    draw_sky();
  }
  begin_shapes(false);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  draw_batches(draw_list_.transparent(), Pass::color);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  beams_.draw(previous, current, mix, shaders_);
  draw_overlay(previous, current, mix, target);

  target.resolve(shaders_);
  glBindVertexArray(0);
  return {};
}

void Renderer::finish() { glFinish(); }
void Renderer::flush() { glFlush(); }

}  // namespace limber::render
