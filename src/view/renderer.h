// Renderer: draws a snapshot into a picture of its own, in whichever context is current: a window's or none's.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "view/draw_list.h"
#include "view/gl.h"
#include "view/lens.h"
#include "view/lighting.h"
#include "view/overlay_lines.h"
#include "view/pixels.h"
#include "view/render_target.h"
#include "view/shaders.h"

namespace limber {

enum class Quality : std::uint8_t { low, medium, high };

class Renderer {
 public:
  /// `api`: of the current context, which outlives it. `shader_folder`: watched by renew_shaders(); empty: the shaders
  /// inside the program. An error: what OpenGL can't do here. [main]
  static Result<std::unique_ptr<Renderer>> make(GlApi api, const std::string& shader_folder, Quality quality);

  /// Draws between two snapshots (`mix` 0: before, 1: now). A picture is at least 1 × 1; an error: too large. [main]
  /// `free`: where nothing will lie over it.
  Result<void> draw(const Snapshot& before, const Snapshot& now, double mix, int width, int height,
                    const FreePart& free = {});
  Result<void> draw(const Snapshot& now, int width, int height) { return draw(now, now, 1, width, height); }
  /// A second picture of the same, with nothing over it, beside the one that draw() makes. [main]
  Result<void> draw_output(const Snapshot& before, const Snapshot& now, double mix, int width, int height);
  /// Calls what draws over the picture drawn last, which is bound, its colours as they are. [main]
  void draw_over(const std::function<void()>& draw) const { target_.draw_over(draw); }
  /// The picture drawn last. [main]
  Pixels read() const { return target_.read(); }
  /// Returns when the picture is drawn. [main]
  static void finish();
  /// Copies it into the window's own framebuffer, stretched to that size. [main]
  void show(int width, int height) const { target_.show(width, height); }
  /// The same of the second picture, in another context that shares objects with this one and is current there.
  /// `frame` is a framebuffer of that context. [main]
  void show_output(const GlFramebuffer& frame, int width, int height) const {
    output_.show_shared(frame, width, height);
  }

  /// Takes over shaders that were saved; true: the picture looks different now. [main]
  bool renew_shaders() { return shaders_.renew(); }
  const std::string& shader_fault() const { return shaders_.fault(); }
  GlApi api() const { return api_.api; }
  /// A side of the largest picture, pixels.
  int largest() const { return largest_; }

 private:
  struct Grade;
  struct GpuMesh {
    GlVertexArray array;
    GlBuffer vertices, indices;
    GLsizei count = 0;
  };
  /// A depth texture to draw into.
  struct DepthMap {
    GlTexture texture;
    GlFramebuffer frame;
  };
  Renderer(GlApi api, std::string shader_folder, const Grade& grade, std::string defines);

  DepthMap make_depth(int side, bool compares) const;
  Result<void> draw_into(RenderTarget& target, const Snapshot& before, const Snapshot& now, double mix, int width,
                         int height, const FreePart& free);
  void draw_overlay(const Snapshot& before, const Snapshot& now, double mix, const RenderTarget& target);
  const GpuMesh& mesh(const MeshKey& key, int detail);
  void forget_meshes();
  void upload(const FrameBlock& frame);
  void draw_depth(const DepthMap& map, int side, const glm::mat4& clip, bool through);
  void draw_batches(const std::vector<Batch>& batches, int coarser, bool casting);
  void draw_mirrored(const Lighting& lighting);
  void draw_floors(const Lighting& lighting, const LookView& look);
  void draw_shadows(const Lighting& lighting);
  void draw_floor(const PlaneView& plane, const Lighting& lighting, bool stage);
  void draw_sky();

  const GlApiInfo& api_;
  const Grade& grade_;
  Shaders shaders_;
  DrawList list_;
  std::shared_ptr<const Drawing> meshes_of_;
  std::map<std::pair<MeshKey, int>, GpuMesh> meshes_;
  GlBuffer instances_, frame_;
  GlVertexArray nothing_;  // for what makes its corners in the shader
  DepthMap lamp_, ground_;
  RenderTarget target_, output_;
  OverlayLines overlay_;
  GlBuffer overlay_buffer_;
  GlVertexArray overlay_array_;
  int largest_ = 0;
};

}  // namespace limber
