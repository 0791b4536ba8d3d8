// Fixtures for rendering tests: a world with bodies, its snapshot, and rendering in an offscreen context.
#pragma once

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/output/publisher.h"
#include "properties/catalog.h"
#include "support/world_objects.h"
#include "ui/render/offscreen.h"
#include "ui/render/renderer.h"

namespace limber::render::test {

inline model::ShapeModel box(const Vec3& size) {
  model::ShapeModel m;
  m.kind = model::ShapeKind::box;
  m.size = size;
  return m;
}
inline model::ShapeModel round(model::ShapeKind kind, double radius, double height = 1) {
  model::ShapeModel m;
  m.kind = kind;
  m.radius = radius;
  m.height = height;
  return m;
}
inline model::ShapeModel plane() {
  model::ShapeModel m;
  m.kind = model::ShapeKind::plane;
  return m;
}

class TestScene {
 public:
  Store store;
  sim::World world{store};

  /// Adds a body with one static part.
  sim::Part& add(const std::string& name, const model::ShapeModel& model, const Vec3& at = {0, 0, 0},
                 const Quat& rotation = quat_identity()) {
    sim::Shape& shape = **world.shapes().add(name, model);
    sim::Body& body = **world.add_body(name);
    return **body.add_part("part", shape, 0, {at, rotation});
  }
  void set(const std::string& path, const std::vector<double>& values) {
    const Result<PropertyRef> place = find_property(store, path);
    ASSERT_TRUE(place.ok() && place->property != nullptr) << path;
    ASSERT_TRUE(store.set(place->node, *place->property, values).ok()) << path;
  }
  /// Sets both colors of a shape: hue, saturation, brightness.
  void paint(const std::string& shape, const Vec3& hsb) {
    for (const char* property : {"ambient_color", "diffuse_color"})
      set(fmt::format("/visuals/shape/{}/{}", shape, property), {hsb.x, hsb.y, hsb.z});
  }
  void look_from(const Vec3& eye, const Vec3& target) { world.visuals().camera().look_at(eye, target); }

  std::shared_ptr<const engine::Snapshot> snapshot() {
    world.flush();
    publisher_.publish(false, 1);
    return latest_.read();
  }

 private:
  Latest<engine::Snapshot> latest_;
  engine::Publisher publisher_{world, latest_};
};

/// The context of an OpenGL version, one for the whole program; makes it current.
inline OffscreenContext& context(GlApi api = GlApi::core) {
  static std::map<GlApi, std::unique_ptr<OffscreenContext>> made;
  std::unique_ptr<OffscreenContext>& one = made[api];
  if (one == nullptr) {
    Result<std::unique_ptr<OffscreenContext>> fresh = OffscreenContext::make(gl_api_info(api).option);
    if (!fresh) {
      ADD_FAILURE() << fresh.error();
      std::abort();
    }
    one = std::move(*fresh);
  }
  one->make_current();
  return *one;
}

inline Renderer& renderer(Quality quality, GlApi api = GlApi::core) {
  // makes the context current before a renderer is destroyed, because it deletes its OpenGL objects
  struct Made {
    GlApi api = GlApi::core;
    std::unique_ptr<Renderer> renderer;
    Made() = default;
    Made(const Made&) = delete;
    Made& operator=(const Made&) = delete;
    ~Made() { (void)context(api); }
  };
  (void)context(api);
  static std::map<std::pair<GlApi, Quality>, Made> made;
  Made& one = made[{api, quality}];
  if (one.renderer == nullptr) {
    Result<std::unique_ptr<Renderer>> fresh = Renderer::make(api, "", quality);
    if (!fresh) {
      ADD_FAILURE() << fresh.error();
      std::abort();
    }
    one.api = api;
    one.renderer = std::move(*fresh);
  }
  return *one.renderer;
}

inline Pixels draw(const engine::Snapshot& now, int width = 160, int height = 90, Quality quality = Quality::low,
                   GlApi api = GlApi::core) {
  Renderer& renderer = test::renderer(quality, api);
  const Result<void> drawn = renderer.draw(now, width, height);
  EXPECT_TRUE(drawn.ok()) << drawn.error();
  return renderer.read();
}
inline Pixels draw(TestScene& scene, int width = 160, int height = 90, Quality quality = Quality::low,
                   GlApi api = GlApi::core) {
  return draw(*scene.snapshot(), width, height, quality, api);
}

/// The color of a pixel: red, green, blue, 0..255.
inline Vec3 color(const Pixels& p, int x, int y) {
  const std::uint8_t* const c = p.at(x, y);
  return {c[0], c[1], c[2]};
}
inline double brightness(const Pixels& p, int x, int y) {
  const Vec3 c = color(p, x, y);
  return (c.x + c.y + c.z) / 3;
}
inline double brightness(const Pixels& p) {
  double sum = 0;
  for (int y = 0; y < p.height; y++) {
    for (int x = 0; x < p.width; x++) sum += brightness(p, x, y);
  }
  return sum / (p.width * p.height);
}

/// A pixel position, from the top left; spot_of() projects a world point.
struct Spot {
  int x = 0;
  int y = 0;
};
inline Spot spot_of(const engine::Snapshot& now, const Vec3& point, int width, int height) {
  const CameraMatrices view_camera = camera_matrices(engine::camera_of(now), width, height);
  const glm::vec4 clip = view_camera.projection * view_camera.view * glm::vec4(glm::vec3(point), 1);
  return {static_cast<int>((0.5 + 0.5 * clip.x / clip.w) * width),
          static_cast<int>((0.5 - 0.5 * clip.y / clip.w) * height)};
}

}  // namespace limber::render::test
