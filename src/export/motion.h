// Motion export: bodies as trees of links with surfaces and joint values, and MotionWriter, the interface of the file
// formats, which receives one frame after another.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber::exporter {

/// Triangles of one color, in the frame of their link, meters.
struct Surface {
  std::vector<std::array<float, 3>> points;
  std::vector<std::array<float, 3>> normals;  ///< Unit, as many as points.
  std::vector<std::array<float, 3>>
      colors;  ///< Linear red, green, blue, multiplied by `color`; as many as points, or none.
  std::vector<std::uint32_t> triangles;  ///< Three indices of points each, counter-clockwise seen from outside.
  Vec3 color{0.5};                       ///< Linear red, green, blue, 0 .. 1.
  double alpha = 1;
};
using Surfaces = std::vector<Surface>;

/// A part of a body (Part); file formats and URDF call it a link.
struct MotionLink {
  std::string name;
  int parent = -1;                           ///< Index among the body's links, in any order; -1: no parent.
  Pose rest;                                 ///< Pose in the body's first link with every joint at 0.
  std::shared_ptr<const Surfaces> surfaces;  ///< Shared by links that look alike; null: invisible.
};

/// A joint, which has one value per degree of freedom.
struct MotionJoint {
  std::string name;
  std::vector<std::string> values;  ///< Names of its values: "angle" (rad), "shift" (m), "angle_x" …
};

/// A body as a tree of links.
struct MotionBody {
  std::string name;
  std::vector<MotionLink> links;
  std::vector<MotionJoint> joints;
  std::vector<std::string> extras = {};  ///< Names of further values, which tables contain: "part/leaf/velocity_x" …
};

/// The state of a body in one frame.
struct MotionSample {
  bool present = false;             ///< False: the body does not exist in this frame; the other fields are unused.
  std::vector<Pose> links;          ///< World poses, Z up.
  std::vector<double> values;       ///< Values of all joints, in the order of MotionBody::joints.
  std::vector<double> extras = {};  ///< In the order of MotionBody::extras.
};

/// The links of a body in depth-first order, each after its parent. Links in cycles are omitted.
struct LinkOrder {
  std::vector<std::size_t> links;
  std::vector<std::size_t> depth;  ///< Number of ancestors of the link at the same index.
};
LinkOrder link_order(const MotionBody& body);

/// Writes one file, or one per body. finish() replaces an existing file; without it no file is left behind. Errors name
/// the file. [one thread]
class MotionWriter {
 public:
  MotionWriter() = default;
  MotionWriter(const MotionWriter&) = delete;
  MotionWriter& operator=(const MotionWriter&) = delete;
  virtual ~MotionWriter() = default;

  /// Declares a body that appears in the next frame for the first time. Bodies are numbered from 0.
  virtual Result<void> add_body(const MotionBody& body) = 0;
  /// Appends a frame. `bodies[i]` is the i-th body that was added. `time`: seconds, one frame period after the
  /// previous.
  virtual Result<void> add_frame(double time, std::span<const MotionSample> bodies) = 0;
  /// Writes everything to disk, under its final name.
  virtual Result<void> finish() = 0;
};

}  // namespace limber::exporter
