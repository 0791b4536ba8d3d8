// HullSurface: a convex triangle surface that grows point by point. Internal to the module: only hull.cpp includes it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "model/mesh/hull.h"

namespace limber::model {

/// Triangles with adjacency. Adding a point marks the faces visible from it as dead; they stay in the list, so that
/// face indices remain valid.
class HullSurface {
 public:
  struct Face {
    std::array<int, 3> vertex{};     ///< Indices into the cloud.
    std::array<int, 3> neighbors{};  ///< The neighboring face across the edge from vertex k to k+1.
    Vec3 normal{0, 0, 1};            ///< Unit, outwards.
    double offset = 0;               ///< normal·p for the points p of the face.
    bool alive = true;
    std::vector<int> outside_set;  ///< Indices of points above this face, the farthest last (quickhull).
  };

  /// Points less than `epsilon` above a face are treated as inside, meters.
  HullSurface(std::span<const Vec3> points, double epsilon) : points_(points), epsilon_(epsilon) {}

  /// Builds the first tetrahedron from points far apart; false if the cloud is thinner than `min_thickness`, meters.
  bool build_tetrahedron(double min_thickness);
  /// Adds a point that lies above `visible_face`. added_faces() and dead_faces() then list the new and removed faces.
  /// False if the surface would become degenerate: then the point is not added.
  bool add(int point, int visible_face);
  /// Signed distance of a point from a face's plane, positive outside.
  double signed_distance(const Face& face, int point) const;
  /// The live face with the plane farthest below the point; -1 if the point is above no face.
  int highest_visible_face(int point) const;
  /// Distance from the surface; 0 inside.
  double distance(int point) const;

  std::vector<Face>& faces() { return faces_; }
  const std::vector<int>& added_faces() const { return added_faces_; }
  const std::vector<int>& dead_faces() const { return dead_faces_; }
  const std::array<int, 4>& corners() const { return corners_; }
  double epsilon() const { return epsilon_; }
  /// The live faces, with vertices renumbered from 0.
  Hull result() const;

 private:
  struct Edge {
    int from, to;
    int neighbor, neighbor_edge;  // the neighboring face that stays, and the index of this edge in it
  };

  bool set_plane(Face& face) const;
  bool find_horizon(int point, int visible_face);
  bool connect_horizon(int point);
  void remove_dead_faces();

  std::span<const Vec3> points_;
  double epsilon_;
  std::array<int, 4> corners_{};
  std::vector<Face> faces_;
  std::vector<int> live_faces_;  // also contains dead faces until the next cleanup
  std::size_t dead_in_live_ = 0;
  std::vector<int> added_faces_;
  std::vector<int> dead_faces_;
  std::vector<char> visited_;
  std::vector<Edge> horizon_;
};

}  // namespace limber::model
