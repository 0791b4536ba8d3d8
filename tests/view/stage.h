// A world that is drawn: bodies by hand, a snapshot of it, and a picture of that in a context without a display.
#pragma once

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/publish.h"
#include "params/catalog.h"
#include "view/offscreen.h"
#include "view/renderer.h"

namespace limber::view_test {

inline ShapeModel box(const Vec3& size) {
  ShapeModel m;
  m.kind = ShapeKind::box;
  m.size = size;
  return m;
}
inline ShapeModel round(ShapeKind kind, double radius, double height = 1) {
  ShapeModel m;
  m.kind = kind;
  m.radius = radius;
  m.height = height;
  return m;
}
inline ShapeModel plane() {
  ShapeModel m;
  m.kind = ShapeKind::plane;
  return m;
}

class Stage {
 public:
  Store store;
  World world{store};

  /// A body of one static part.
  Part& add(const std::string& name, const ShapeModel& model, const Vec3& at = {0, 0, 0},
            const Quat& turn = quat_identity()) {
    Shape& shape = **world.add_shape(name, model);
    Body& body = **world.add_body(name);
    return **body.add_part("part", shape, 0, {at, turn});
  }
  void set(const std::string& path, const std::vector<double>& values) {
    const Result<Place> place = find_place(store, path);
    ASSERT_TRUE(place.ok() && place->row != nullptr) << path;
    ASSERT_TRUE(store.set(place->node, *place->row, values).ok()) << path;
  }
  /// Both colours of a shape, hue, saturation and brightness.
  void paint(const std::string& shape, const Vec3& hsb) {
    for (const char* row : {"ambient_color", "diffuse_color"})
      set(fmt::format("/visuals/shape/{}/{}", shape, row), {hsb.x, hsb.y, hsb.z});
  }
  void look_from(const Vec3& eye, const Vec3& target) { world.visuals().camera().look_at(eye, target); }

  std::shared_ptr<const Snapshot> snapshot() {
    world.settle();
    publisher_.publish(false, 1);
    return latest_.read();
  }

 private:
  Latest<Snapshot> latest_;
  Publisher publisher_{world, latest_};
};

/// One context of each kind for the whole program, made current.
inline Offscreen& context(GlApi api = GlApi::core) {
  static std::map<GlApi, std::unique_ptr<Offscreen>> made;
  std::unique_ptr<Offscreen>& one = made[api];
  if (one == nullptr) {
    Result<std::unique_ptr<Offscreen>> fresh = Offscreen::make(gl_api_info(api).option);
    if (!fresh) {
      ADD_FAILURE() << fresh.error();
      std::abort();
    }
    one = std::move(*fresh);
  }
  one->use();
  return *one;
}

inline Renderer& renderer(Quality quality, GlApi api = GlApi::core) {
  // a renderer's objects are deleted in its context, which it goes before
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

inline Pixels draw(const Snapshot& now, int width = 160, int height = 90, Quality quality = Quality::low,
                   GlApi api = GlApi::core) {
  Renderer& renderer = view_test::renderer(quality, api);
  const Result<void> drawn = renderer.draw(now, width, height);
  EXPECT_TRUE(drawn.ok()) << drawn.error();
  return renderer.read();
}
inline Pixels draw(Stage& stage, int width = 160, int height = 90, Quality quality = Quality::low,
                   GlApi api = GlApi::core) {
  return draw(*stage.snapshot(), width, height, quality, api);
}

/// Red, green, blue, 0 .. 255.
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

/// Where a point of the world is seen, in pixels from the top left.
struct Spot {
  int x = 0;
  int y = 0;
};
inline Spot spot_of(const Snapshot& now, const Vec3& point, int width, int height) {
  const Lens lens = lens_of(camera_of(now), width, height);
  const glm::vec4 clip = lens.projection * lens.view * glm::vec4(glm::vec3(point), 1);
  return {static_cast<int>((0.5 + 0.5 * clip.x / clip.w) * width),
          static_cast<int>((0.5 - 0.5 * clip.y / clip.w) * height)};
}

}  // namespace limber::view_test
