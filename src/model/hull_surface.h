// A convex surface that grows point by point. Part of the room's inside: only hull.cpp includes it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "model/hull.h"

namespace limber {

/// Triangles with their neighbours. Faces that a new point sees die and stay in the list, so indices hold.
class HullSurface {
 public:
  struct Face {
    std::array<int, 3> vertex{};  ///< Indices into the cloud.
    std::array<int, 3> across{};  ///< The face behind the edge from vertex k to k+1.
    Vec3 normal{0, 0, 1};         ///< Unit, outwards.
    double offset = 0;            ///< normal·p of the face's points.
    bool alive = true;
    std::vector<int> outside;  ///< Points that see this face, the farthest last.
  };

  /// `epsilon`: points within it count as inside.
  HullSurface(std::span<const Vec3> points, double epsilon) : points_(points), epsilon_(epsilon) {}

  /// Four corners that span a volume; false when the cloud is thinner than `thinnest`, metres.
  bool start(double thinnest);
  /// Adds a point that lies above `seen`. The faces made are added_faces(), those that died are dead_faces().
  /// False when the surface would become degenerate: the point is then left out.
  bool add(int point, int seen);
  /// Distance above a face's plane, negative below.
  double above(const Face& face, int point) const;
  /// The living face whose plane the point is highest above; -1 when it is above none.
  int face_below(int point) const;
  /// Distance from the surface; 0 inside.
  double distance(int point) const;

  std::vector<Face>& faces() { return faces_; }
  const std::vector<int>& added_faces() const { return added_; }
  const std::vector<int>& dead_faces() const { return dead_; }
  const std::array<int, 4>& corners() const { return corners_; }
  double epsilon() const { return epsilon_; }
  /// The living faces, with vertices numbered anew.
  Hull result() const;

 private:
  struct Edge {
    int from, to;
    int face, side;  // what lies behind it, and that face's edge
  };

  bool set_plane(Face& face) const;
  bool find_horizon(int point, int seen);
  bool close(int point);
  void drop_dead();

  std::span<const Vec3> points_;
  double epsilon_;
  std::array<int, 4> corners_{};
  std::vector<Face> faces_;
  std::vector<int> live_;  // and some dead ones
  std::size_t dead_in_list_ = 0;
  std::vector<int> added_;
  std::vector<int> dead_;
  std::vector<char> marked_;
  std::vector<Edge> horizon_;
};

}  // namespace limber
