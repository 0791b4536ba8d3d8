// Triangle meshes of known solids, and their encoding as mesh files.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/vec.h"

namespace limber::model::test {

struct Solid {
  std::vector<Vec3> vertices;
  std::vector<unsigned> triangles;

  void quad(unsigned a, unsigned b, unsigned c, unsigned d) { triangles.insert(triangles.end(), {a, b, c, a, c, d}); }
  Solid moved(const Pose& pose) const {
    Solid out = *this;
    for (Vec3& v : out.vertices) v = pose * v;
    return out;
  }
  void add(const Solid& other) {
    const auto base = static_cast<unsigned>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const unsigned t : other.triangles) triangles.push_back(base + t);
  }
};

inline Solid box(const Vec3& size) {
  Solid s;
  for (unsigned i = 0; i < 8; ++i) {
    s.vertices.push_back(Vec3(i & 1u ? 0.5 : -0.5, i & 2u ? 0.5 : -0.5, i & 4u ? 0.5 : -0.5) * size);
  }
  s.quad(0, 2, 3, 1);
  s.quad(4, 5, 7, 6);
  s.quad(0, 1, 5, 4);
  s.quad(2, 6, 7, 3);
  s.quad(0, 4, 6, 2);
  s.quad(1, 3, 7, 5);
  return s;
}

/// A surface of revolution about z through (radius, z) points from bottom to top; radius 0 at both ends.
inline Solid revolved(const std::vector<std::pair<double, double>>& profile, unsigned around) {
  Solid s;
  const auto rings = static_cast<unsigned>(profile.size()) - 2;
  s.vertices.emplace_back(0, 0, profile.front().second);
  for (unsigned r = 1; r <= rings; ++r) {
    for (unsigned i = 0; i < around; ++i) {
      const double angle = 2 * kPi * i / around;
      s.vertices.emplace_back(profile[r].first * std::cos(angle), profile[r].first * std::sin(angle),
                              profile[r].second);
    }
  }
  s.vertices.emplace_back(0, 0, profile.back().second);
  const unsigned top = static_cast<unsigned>(s.vertices.size()) - 1;
  for (unsigned i = 0; i < around; ++i) {
    const unsigned next = (i + 1) % around;
    s.triangles.insert(s.triangles.end(), {0, 1 + next, 1 + i});
    for (unsigned r = 0; r + 1 < rings; ++r) {
      const unsigned low = 1 + r * around, high = low + around;
      s.quad(low + i, low + next, high + next, high + i);
    }
    const unsigned last = 1 + (rings - 1) * around;
    s.triangles.insert(s.triangles.end(), {last + i, last + next, top});
  }
  return s;
}

inline Solid capsule(double radius, double height, unsigned around = 32) {
  std::vector<std::pair<double, double>> profile;
  const unsigned rings = around / 4;
  for (unsigned i = 0; i <= rings; ++i) {
    const double a = kPi / 2 * i / rings;
    profile.emplace_back(radius * std::sin(a), -height / 2 - radius * std::cos(a));
  }
  for (unsigned i = height > 0 ? 0 : 1; i <= rings; ++i) {
    const double a = kPi / 2 * i / rings;
    profile.emplace_back(i == rings ? 0 : radius * std::cos(a), height / 2 + radius * std::sin(a));
  }
  profile.front().first = 0;
  return revolved(profile, around);
}

inline Solid cylinder(double radius, double height, unsigned around = 32) {
  return revolved({{0, -height / 2}, {radius, -height / 2}, {radius, height / 2}, {0, height / 2}}, around);
}

inline std::string binary_stl(const Solid& s, const std::string& header = "binary") {
  std::string out = header;
  out.resize(80, ' ');
  const auto put = [&](const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); };
  const auto count = static_cast<std::uint32_t>(s.triangles.size() / 3);
  put(&count, 4);
  for (std::size_t i = 0; i < s.triangles.size(); i += 3) {
    const float zero[3] = {0, 0, 0};
    put(zero, 12);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = s.vertices[s.triangles[i + k]];
      const float p[3] = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
      put(p, 12);
    }
    out.append(2, '\0');
  }
  return out;
}

inline std::string ascii_stl(const Solid& s) {
  std::string out = "solid test\n";
  for (std::size_t i = 0; i < s.triangles.size(); i += 3) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = s.vertices[s.triangles[i + k]];
      out += fmt::format("vertex {} {} {}\n", v.x, v.y, v.z);
    }
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid test\n";
}

inline std::string obj(const Solid& s) {
  std::string out = "mtllib missing.mtl\n";
  for (const Vec3& v : s.vertices) out += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  for (std::size_t i = 0; i < s.triangles.size(); i += 3) {
    out += fmt::format("f {} {} {}\n", s.triangles[i] + 1, s.triangles[i + 1] + 1, s.triangles[i + 2] + 1);
  }
  return out;
}

/// A Collada file with this unit and up axis, and one node with the transform elements in `node`.
inline std::string dae(const Solid& s, double meter, const std::string& up, const std::string& node) {
  std::string points, faces;
  for (const Vec3& v : s.vertices) points += fmt::format("{} {} {} ", v.x, v.y, v.z);
  for (const unsigned t : s.triangles) faces += fmt::format("{} ", t);
  return fmt::format(R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{}" name="u"/><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="{}">{}</float_array><technique_common>
<accessor source="#pa" count="{}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{}"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">{}<instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
                     meter, up, s.vertices.size() * 3, points, s.vertices.size(), s.triangles.size() / 3, faces, node);
}

}  // namespace limber::model::test
