// Renderer: draws snapshots into an offscreen image, in the current OpenGL context (a window's or an offscreen one).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ui/render/beams.h"
#include "ui/render/camera.h"
#include "ui/render/draw_list.h"
#include "ui/render/gl.h"
#include "ui/render/lighting.h"
#include "ui/render/overlay_lines.h"
#include "ui/render/pixels.h"
#include "ui/render/render_target.h"
#include "ui/render/shaders.h"
#include "ui/render/texture.h"

namespace limber::render {

/// Levels of rendering quality.
enum class Quality : std::uint8_t { low, medium, high };

/// [main]
class Renderer {
 public:
  /// Creates a renderer. `api`: of the current context, which must outlive the renderer. `shader_folder`: watched by
  /// reload_shaders(); empty: use the embedded shaders. Errors if the driver lacks a required feature. [main]
  static Result<std::unique_ptr<Renderer>> make(GlApi api, const std::string& shader_folder, Quality quality);

  /// Draws the scene interpolated between two snapshots (`mix` 0: `previous`, 1: `current`). Sizes below 1 are raised
  /// to 1; errors if the size is above max_size() or memory is insufficient. `free_area`: the part not covered by
  /// panels. [main]
  Result<void> draw(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, int width,
                    int height, const FreeArea& free_area = {});
  Result<void> draw(const engine::Snapshot& current, int width, int height) {
    return draw(current, current, 1, width, height);
  }
  /// Draws the scene as this camera sees it, instead of that of the snapshot. [main]
  Result<void> draw_from(const engine::Snapshot& current, const engine::CameraSettings& camera, int width, int height);
  /// Draws a second image of the scene for the output window, without panels; independent of draw()'s image. [main]
  Result<void> draw_output(const engine::Snapshot& previous, const engine::Snapshot& current, double mix, int width,
                           int height);
  /// Calls `draw` with draw()'s last image bound as the framebuffer, without sRGB conversion. [main]
  void draw_over(const std::function<void()>& draw) const { target_.draw_over(draw); }
  /// Reads back draw()'s last image. [main]
  Pixels read() const { return target_.read(); }
  /// Waits until the GPU has finished drawing. [main]
  static void finish();
  /// Sends the drawing to the GPU without waiting, so that another context sees the new image. [main]
  static void flush();
  /// Copies draw()'s last image to the window's default framebuffer, scaled to that size. [main]
  void present(int width, int height) const { target_.present(width, height); }
  /// Copies draw_output()'s last image; called with another context current, which shares objects with the first.
  /// `framebuffer` belongs to that other context. [main]
  void present_output(const GlFramebuffer& framebuffer, int width, int height) const {
    output_.present_shared(framebuffer, width, height);
  }

  /// Reloads shaders from changed files; true if the view must be drawn again. [main]
  bool reload_shaders() { return shaders_.reload(); }
  /// The error of the last shader reload; empty if it succeeded. [main]
  const std::string& shader_error() const { return shaders_.error(); }
  GlApi api() const { return api_.api; }
  /// Largest width and height of an image, pixels.
  int max_size() const { return max_size_; }

 private:
  struct QualitySettings;
  struct GpuMesh {
    GlVertexArray array;
    GlBuffer vertices, indices;
    int count = 0;
  };
  enum class Pass : std::uint8_t { depth, color };
  // a depth texture with its framebuffer
  struct DepthMap {
    GlTexture texture;
    GlFramebuffer framebuffer;
  };
  Renderer(GlApi api, std::string shader_folder, const QualitySettings& settings, std::string defines);

  DepthMap make_depth(int side, bool compares) const;
  Result<void> draw_into(RenderTarget& target, const engine::Snapshot& previous, const engine::Snapshot& current,
                         double mix, const engine::CameraSettings& camera, int width, int height,
                         const FreeArea& free_area);
  void draw_overlay(const engine::Snapshot& previous, const engine::Snapshot& current, double mix,
                    const RenderTarget& target);
  const GpuMesh& mesh(const MeshKey& key, int detail);
  template <class Vertex>
  static GpuMesh make_mesh(const std::vector<Vertex>& triangles);
  void make_colored_meshes(const MeshKey& key, int detail);
  void begin_shapes(bool mirrored);
  void use_coloring(const MeshKey& key);
  void release_unused_meshes();
  void upload(const FrameUniforms& frame);
  void draw_depth(const DepthMap& map, int side, const glm::mat4& clip, bool clamp_depth);
  void draw_batches(const std::vector<Batch>& batches, Pass pass);
  void draw_mirrored(const Lighting& lighting);
  void draw_planes(const Lighting& lighting, const engine::AppearanceSettings& appearance);
  void upload_instances();
  void draw_depth_maps(const Lighting& lighting);
  void draw_plane(const RenderPlane& plane, const Lighting& lighting, bool is_floor);
  void draw_sky();

  const GlApiInfo& api_;
  const QualitySettings& settings_;
  Shaders shaders_;
  DrawList draw_list_;
  std::shared_ptr<const engine::RenderScene> meshes_scene_;
  std::map<std::pair<MeshKey, int>, GpuMesh> meshes_;
  std::map<const model::Image*, GlTexture> textures_;
  GlTexture white_;  // for colored meshes without a texture
  // of the color pass that is being drawn: programs for plain and colored meshes, and the bound program and texture
  std::array<std::uint32_t, 2> shape_programs_{};
  bool colored_bound_ = false;
  std::uint32_t bound_texture_ = 0;
  GlBuffer instances_, uniforms_;
  GlVertexArray no_attributes_;  // without attributes, for shaders that generate their vertices
  DepthMap shadow_map_, ground_map_;
  RenderTarget target_, output_;
  Beams beams_;
  OverlayLines overlay_;
  GlBuffer overlay_buffer_;
  GlVertexArray overlay_array_;
  int max_size_ = 0;
};

}  // namespace limber::render
