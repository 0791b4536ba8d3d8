// Motion: bodies as other programs take them: links in a tree, with what is seen of them, joints' values; and a writer
// of a format, which is given one frame after the other.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber {

/// Triangles of one colour, in the frame of their link, metres.
struct Surface {
  std::vector<std::array<float, 3>> points;
  std::vector<std::array<float, 3>> normals;  ///< Unit, as many as points.
  std::vector<std::uint32_t> triangles;       ///< Three places among the points each, counter-clockwise from outside.
  Vec3 color{0.5};                            ///< Linear red, green, blue, 0 .. 1.
  double alpha = 1;
};
using Surfaces = std::vector<Surface>;

struct MotionLink {
  std::string name;
  int parent = -1;                           ///< Among the body's links, in any order; -1: it hangs on nothing.
  Pose rest;                                 ///< In the body's first link, with every joint at 0.
  std::shared_ptr<const Surfaces> surfaces;  ///< Links that look alike share them; null: nothing is seen.
};

struct MotionJoint {
  std::string name;
  std::vector<std::string> values;  ///< What is told of it: "angle" (rad), "shift" (m), "angle_x" …
};

struct MotionBody {
  std::string name;
  std::vector<MotionLink> links;
  std::vector<MotionJoint> joints;
};

/// A body at one time.
struct MotionSample {
  bool there = false;
  std::vector<Pose> links;     ///< World, Z up.
  std::vector<double> values;  ///< Of all joints, one after the other.
};

/// The links of a body, each behind its parent, the branches one after the other; cycles are nobody's.
struct LinkOrder {
  std::vector<std::size_t> links;
  std::vector<std::size_t> depth;  ///< Of the link at the same place: how many are above it.
};
LinkOrder link_order(const MotionBody& body);

/// Writes one file, or one a body. What is there already is replaced by finish(); without it nothing stays. Errors name
/// the file. [one thread]
class MotionWriter {
 public:
  MotionWriter() = default;
  MotionWriter(const MotionWriter&) = delete;
  MotionWriter& operator=(const MotionWriter&) = delete;
  virtual ~MotionWriter() = default;

  /// A body that is in the next frame for the first time; bodies are counted from 0.
  virtual Result<void> add_body(const MotionBody& body) = 0;
  /// `bodies[i]` is the i-th body that was added. `time`: seconds, a frame's length behind the one before.
  virtual Result<void> add_frame(double time, std::span<const MotionSample> bodies) = 0;
  /// Everything is on the disk, under its name.
  virtual Result<void> finish() = 0;
};

}  // namespace limber
