// Writes each link of the body as a BVH joint. BVH has no rest rotations, so rotations are relative to the rest pose.
#include "export/writers.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/text.h"
#include "export/atomic_file.h"
#include "export/names.h"

namespace limber::exporter {

namespace {

constexpr const char* kChannels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
constexpr std::size_t kCountWidth = 12;  // characters reserved for the number of frames, which is patched at the end
constexpr std::size_t kMaxIndent = 40;

// the rotation from Z up to Y up
const Quat& y_up_rotation() {
  static const Quat turn = quat_axis({1, 0, 0}, -kPi / 2);
  return turn;
}
Vec3 y_up(const Vec3& v) { return {v.x, v.z, -v.y}; }
Quat y_up(const Quat& q) { return y_up_rotation() * q * glm::conjugate(y_up_rotation()); }

double nearest_angle(double angle, double previous) {
  return angle + 2 * kPi * std::round((previous - angle) / (2 * kPi));
}

// the end site of a link without children, in its own frame: on the far side of its bounding box
Vec3 end_site_of(const MotionLink& link) {
  Vec3 low(1e30);
  Vec3 high(-1e30);
  if (link.surfaces != nullptr) {
    for (const Surface& surface : *link.surfaces) {
      for (const auto& p : surface.points) {
        low = glm::min(low, Vec3(p[0], p[1], p[2]));
        high = glm::max(high, Vec3(p[0], p[1], p[2]));
      }
    }
  }
  if (low.x > high.x) return {0, 0, 0.1};
  const Vec3 across = low + high;
  if (glm::length(across) > 1e-3) return across;
  return {0, 0, std::max(high.z, 1e-3)};
}

// the file of one body
class BvhFile {
 public:
  BvhFile(const std::string& path, const MotionBody& body, double rate) : file_(path), rate_(rate) {
    order_ = link_order(body);
    index_of_.assign(body.links.size(), 0);
    for (std::size_t i = 0; i < order_.links.size(); i++) index_of_[order_.links[i]] = i;
    for (const std::size_t link : order_.links) {
      rest_poses_.push_back(body.links[link].rest);
      parent_.push_back(body.links[link].parent);
    }
    // a body with several root links gets a common root at rest
    has_several_roots_ = std::count(order_.depth.begin(), order_.depth.end(), 0u) > 1;
    previous_angles_.assign(order_.links.size(), Vec3(0));
  }

  Result<void> begin(const MotionBody& body) {
    if (Result<void> opened = file_.open(); !opened) return opened;
    std::string text = "HIERARCHY\n";
    if (has_several_roots_)
      text += fmt::format("ROOT {}\n{{\n  OFFSET 0 0 0\n  {}", names_.unique(sanitize_bvh_name(body.name)), kChannels);
    for (std::size_t i = 0; i < order_.links.size(); i++) add_joint(text, body, i);
    close_joints(text, has_several_roots_ ? 1 : 0);
    if (has_several_roots_) text += "}\n";
    text += "MOTION\nFrames: ";
    count_at_ = text.size();
    text += std::string(kCountWidth, ' ') + fmt::format("\nFrame Time: {:.9f}\n", 1 / rate_);
    return file_.write(text);
  }

  /// Appends a frame `times` times. The first sample is also used for the frames before the body appeared.
  Result<void> add_sample(const MotionSample& sample, std::uint64_t times) {
    line_ = has_several_roots_ ? "0 0 0 0 0 0 " : "";
    poses_.clear();
    for (std::size_t i = 0; i < order_.links.size(); i++) {
      const Pose& pose = sample.links[order_.links[i]];
      const Pose now = {y_up(pose.position), y_up(pose.rotation * glm::conjugate(rest_poses_[i].rotation))};
      poses_.push_back(now);
      const Pose local_pose =
          parent_[i] < 0 ? now : poses_[index_of_[static_cast<std::size_t>(parent_[i])]].inverse() * now;
      previous_angles_[i] = bvh_angles(local_pose.rotation, previous_angles_[i]);
      const Vec3& p = local_pose.position;
      const Vec3 a = previous_angles_[i] * (180 / kPi);
      for (const double value : {p.x, p.y, p.z, a.x, a.y, a.z})
        fmt::format_to(std::back_inserter(line_), "{:.6f} ", value);
    }
    line_.back() = '\n';
    return repeat(times);
  }

  /// Repeats the last frame.
  Result<void> repeat(std::uint64_t times = 1) {
    for (; times > 0; times--) {
      if (Result<void> written = file_.write(line_); !written) return written;
      count_++;
    }
    return {};
  }

  Result<void> finish() {
    const std::string count = fmt::format("{:<{}}", count_, kCountWidth);
    if (Result<void> patched = file_.patch(count_at_, count); !patched) return patched;
    return file_.finish();
  }

 private:
  static std::string indent(std::size_t depth) { return std::string(2 * std::min(depth, kMaxIndent), ' '); }

  // closes the open joints down to that depth
  void close_joints(std::string& text, std::size_t depth) {
    while (open_joints_.size() > depth - (has_several_roots_ ? 1 : 0)) {
      const std::size_t level = open_joints_.size() - 1 + (has_several_roots_ ? 1 : 0);
      if (!open_joints_.back().has_children)
        text += fmt::format("{0}End Site\n{0}{{\n{1}OFFSET {2:.6f} {3:.6f} {4:.6f}\n{0}}}\n", indent(level + 1),
                            indent(level + 2), open_joints_.back().end_offset.x, open_joints_.back().end_offset.y,
                            open_joints_.back().end_offset.z);
      text += indent(level) + "}\n";
      open_joints_.pop_back();
    }
  }

  void add_joint(std::string& text, const MotionBody& body, std::size_t i) {
    const std::size_t depth = order_.depth[i] + (has_several_roots_ ? 1 : 0);
    close_joints(text, depth);
    const MotionLink& link = body.links[order_.links[i]];
    Vec3 offset = y_up(rest_poses_[i].position);
    if (parent_[i] >= 0) {
      open_joints_.back().has_children = true;
      offset -= y_up(rest_poses_[index_of_[static_cast<std::size_t>(parent_[i])]].position);
    }
    text += fmt::format("{0}{1} {2}\n{0}{{\n{3}OFFSET {4:.6f} {5:.6f} {6:.6f}\n{3}{7}", indent(depth),
                        depth == 0 ? "ROOT" : "JOINT", names_.unique(sanitize_bvh_name(link.name)), indent(depth + 1),
                        offset.x, offset.y, offset.z, kChannels);
    open_joints_.push_back({false, y_up(rest_poses_[i].rotation * end_site_of(link))});
  }

  struct OpenJoint {
    bool has_children = false;
    Vec3 end_offset{0};
  };

  AtomicFile file_;
  double rate_;
  UniqueNames names_;
  LinkOrder order_;
  std::vector<std::size_t> index_of_;  // by link: its index in order_
  std::vector<Pose> rest_poses_;       // in the order of order_, like the following vectors
  std::vector<int> parent_;            // index of a link
  std::vector<Vec3> previous_angles_;  // of the previous frame
  std::vector<Pose> poses_;
  std::vector<OpenJoint> open_joints_;
  bool has_several_roots_ = false;
  std::string line_;
  std::uint64_t count_at_ = 0;
  std::uint64_t count_ = 0;
};

class BvhWriter : public MotionWriter {
 public:
  BvhWriter(std::string path, double rate)
      : path_(std::move(path)), rate_(rate), single_file_(path_.ends_with(".bvh")), folder_(temporary_name(path_)) {}
  ~BvhWriter() override {
    files_.clear();
    std::error_code ignored;
    if (!single_file_ && !finished_) std::filesystem::remove_all(folder_, ignored);
  }

  Result<void> begin() {
    if (single_file_ || system::make_folder(folder_, 0777)) return {};
    return failed();
  }

  Result<void> add_body(const MotionBody& body) override {
    if (single_file_ && !files_.empty())
      return Error{
          fmt::format("{}: a BVH file contains one body, but '{}' was added. Choose one with "
                      "--body, or give the name of a folder, without .bvh",
                      printable(path_), printable(body.name))};
    const std::string name =
        single_file_ ? path_ : fmt::format("{}/{}.bvh", folder_, names_.unique(sanitize_file_name(body.name)));
    files_.push_back(std::make_unique<BvhFile>(name, body, rate_));
    return files_.back()->begin(body);
  }

  Result<void> add_frame(double, std::span<const MotionSample> bodies) override {
    frames_++;
    for (std::size_t i = 0; i < bodies.size(); i++) {
      const bool first = i >= previous_bodies_;
      Result<void> added =
          bodies[i].present ? files_[i]->add_sample(bodies[i], first ? frames_ : 1) : files_[i]->repeat();
      if (!added) return added;
    }
    previous_bodies_ = bodies.size();
    return {};
  }

  Result<void> finish() override {
    if (files_.empty()) return Error{fmt::format("{}: there is no body to write", printable(path_))};
    for (const auto& file : files_) {
      if (Result<void> finished = file->finish(); !finished) return finished;
    }
    if (!single_file_ && std::rename(folder_.c_str(), path_.c_str()) != 0) return failed();
    finished_ = true;
    return {};
  }

 private:
  Error failed() const {
    return Error{fmt::format("{} can't be written: {}", printable(path_), std::generic_category().message(errno))};
  }

  std::string path_;
  double rate_;
  bool single_file_;
  bool finished_ = false;
  std::string folder_;  // temporary name until finish()
  UniqueNames names_;
  std::vector<std::unique_ptr<BvhFile>> files_;
  std::size_t previous_bodies_ = 0;  // number of bodies in the previous frame
  std::uint64_t frames_ = 0;
};

}  // namespace

Vec3 bvh_angles(const Quat& rotation, const Vec3& previous) {
  const Mat3 m = glm::mat3_cast(rotation);  // m[column][row]
  const double sin_x = std::clamp(m[1][2], -1.0, 1.0);
  const double x = fixed::asin(sin_x);
  if (1 - std::abs(sin_x) < 1e-12) {
    // gimbal lock, z and y rotate about the same axis: keep y and solve for z
    const Mat3 rest = glm::mat3_cast(rotation * quat_axis({0, 1, 0}, -previous.z));
    return {nearest_angle(fixed::atan2(rest[0][1], rest[0][0]), previous.x), nearest_angle(x, previous.y), previous.z};
  }
  const Vec3 angles(fixed::atan2(-m[1][0], m[1][1]), x, fixed::atan2(-m[0][2], m[2][2]));
  const auto nearest = [&](const Vec3& a) {
    return Vec3(nearest_angle(a.x, previous.x), nearest_angle(a.y, previous.y), nearest_angle(a.z, previous.z));
  };
  const Vec3 first_solution = nearest(angles);
  const Vec3 second_solution = nearest({angles.x + kPi, kPi - angles.y, angles.z + kPi});
  return glm::length(first_solution - previous) <= glm::length(second_solution - previous) ? first_solution
                                                                                           : second_solution;
}

Result<std::unique_ptr<MotionWriter>> make_bvh_writer(const std::string& path, double rate) {
  auto writer = std::make_unique<BvhWriter>(path, rate);
  if (const Result<void> begun = writer->begin(); !begun) return Error{begun.error()};
  return std::unique_ptr<MotionWriter>(std::move(writer));
}

}  // namespace limber::exporter
