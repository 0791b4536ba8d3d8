// A joint of the file is a link of the body: at rest it is not turned, so what it has turned is against the rest pose.
#include "motion/bvh.h"

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
#include "motion/names.h"
#include "motion/out_file.h"

namespace limber {

namespace {

constexpr const char* kChannels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
constexpr std::size_t kCountWidth = 12;  // digits that are left free for the number of frames
constexpr std::size_t kMostIndent = 40;

// Z up to Y up
const Quat& upright() {
  static const Quat turn = quat_axis({1, 0, 0}, -kPi / 2);
  return turn;
}
Vec3 y_up(const Vec3& v) { return {v.x, v.z, -v.y}; }
Quat y_up(const Quat& q) { return upright() * q * glm::conjugate(upright()); }

double nearest_turn(double angle, double before) { return angle + 2 * kPi * std::round((before - angle) / (2 * kPi)); }

// where a link that carries none ends, in its own frame: across what is seen of it
Vec3 far_end(const MotionLink& link) {
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

// one body's file
class BvhFile {
 public:
  BvhFile(const std::string& path, const MotionBody& body, double rate) : file_(path), rate_(rate) {
    order_ = link_order(body);
    place_of_.assign(body.links.size(), 0);
    for (std::size_t i = 0; i < order_.links.size(); i++) place_of_[order_.links[i]] = i;
    for (const std::size_t link : order_.links) {
      rest_.push_back(body.links[link].rest);
      parent_.push_back(body.links[link].parent);
    }
    // trees beside each other get a root that stands still
    many_ = std::count(order_.depth.begin(), order_.depth.end(), 0u) > 1;
    before_.assign(order_.links.size(), Vec3(0));
  }

  Result<void> begin(const MotionBody& body) {
    if (Result<void> opened = file_.open(); !opened) return opened;
    std::string text = "HIERARCHY\n";
    if (many_) text += fmt::format("ROOT {}\n{{\n  OFFSET 0 0 0\n  {}", names_.unique(word_name(body.name)), kChannels);
    for (std::size_t i = 0; i < order_.links.size(); i++) add_joint(text, body, i);
    close(text, many_ ? 1 : 0);
    if (many_) text += "}\n";
    text += "MOTION\nFrames: ";
    count_at_ = text.size();
    text += std::string(kCountWidth, ' ') + fmt::format("\nFrame Time: {:.9f}\n", 1 / rate_);
    return file_.put(text);
  }

  /// Before the body came it stood as it is in its first frame.
  Result<void> add(const MotionSample& sample, std::uint64_t times) {
    line_ = many_ ? "0 0 0 0 0 0 " : "";
    turned_.clear();
    for (std::size_t i = 0; i < order_.links.size(); i++) {
      const Pose& pose = sample.links[order_.links[i]];
      const Pose now = {y_up(pose.position), y_up(pose.rotation * glm::conjugate(rest_[i].rotation))};
      turned_.push_back(now);
      const Pose own = parent_[i] < 0 ? now : turned_[place_of_[static_cast<std::size_t>(parent_[i])]].inverse() * now;
      before_[i] = bvh_angles(own.rotation, before_[i]);
      const Vec3& p = own.position;
      const Vec3 a = before_[i] * (180 / kPi);
      for (const double value : {p.x, p.y, p.z, a.x, a.y, a.z})
        fmt::format_to(std::back_inserter(line_), "{:.6f} ", value);
    }
    line_.back() = '\n';
    return again(times);
  }

  /// The same frame once more.
  Result<void> again(std::uint64_t times = 1) {
    for (; times > 0; times--) {
      if (Result<void> put = file_.put(line_); !put) return put;
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
  static std::string indent(std::size_t depth) { return std::string(2 * std::min(depth, kMostIndent), ' '); }

  // ends the joints down to that depth
  void close(std::string& text, std::size_t depth) {
    while (open_.size() > depth - (many_ ? 1 : 0)) {
      const std::size_t level = open_.size() - 1 + (many_ ? 1 : 0);
      if (!open_.back().carries)
        text += fmt::format("{0}End Site\n{0}{{\n{1}OFFSET {2:.6f} {3:.6f} {4:.6f}\n{0}}}\n", indent(level + 1),
                            indent(level + 2), open_.back().end.x, open_.back().end.y, open_.back().end.z);
      text += indent(level) + "}\n";
      open_.pop_back();
    }
  }

  void add_joint(std::string& text, const MotionBody& body, std::size_t i) {
    const std::size_t depth = order_.depth[i] + (many_ ? 1 : 0);
    close(text, depth);
    const MotionLink& link = body.links[order_.links[i]];
    Vec3 offset = y_up(rest_[i].position);
    if (parent_[i] >= 0) {
      open_.back().carries = true;
      offset -= y_up(rest_[place_of_[static_cast<std::size_t>(parent_[i])]].position);
    }
    text += fmt::format("{0}{1} {2}\n{0}{{\n{3}OFFSET {4:.6f} {5:.6f} {6:.6f}\n{3}{7}", indent(depth),
                        depth == 0 ? "ROOT" : "JOINT", names_.unique(word_name(link.name)), indent(depth + 1), offset.x,
                        offset.y, offset.z, kChannels);
    open_.push_back({false, y_up(rest_[i].rotation * far_end(link))});
  }

  struct OpenJoint {
    bool carries = false;  // another joint
    Vec3 end{0};
  };

  OutFile file_;
  double rate_;
  UniqueNames names_;
  LinkOrder order_;
  std::vector<std::size_t> place_of_;  // of a link in that order
  std::vector<Pose> rest_;             // in that order, as all that follow
  std::vector<int> parent_;            // a link
  std::vector<Vec3> before_;           // angles of the last frame
  std::vector<Pose> turned_;
  std::vector<OpenJoint> open_;
  bool many_ = false;
  std::string line_;
  std::uint64_t count_at_ = 0;
  std::uint64_t count_ = 0;
};

class BvhWriter : public MotionWriter {
 public:
  BvhWriter(std::string path, double rate)
      : path_(std::move(path)), rate_(rate), single_(path_.ends_with(".bvh")), folder_(beside_name(path_)) {}
  ~BvhWriter() override {
    files_.clear();
    std::error_code gone;
    if (!single_ && !done_) std::filesystem::remove_all(folder_, gone);
  }

  Result<void> begin() {
    if (single_ || system::make_folder(folder_, 0777)) return {};
    return failed();
  }

  Result<void> add_body(const MotionBody& body) override {
    if (single_ && !files_.empty())
      return Error{
          fmt::format("{} is one file, and a BVH file holds one body, but here is '{}' too: choose one by "
                      "--body, or give a folder's name, without .bvh",
                      printable(path_), printable(body.name))};
    const std::string name = single_ ? path_ : fmt::format("{}/{}.bvh", folder_, names_.unique(file_name(body.name)));
    files_.push_back(std::make_unique<BvhFile>(name, body, rate_));
    return files_.back()->begin(body);
  }

  Result<void> add_frame(double, std::span<const MotionSample> bodies) override {
    frames_++;
    for (std::size_t i = 0; i < bodies.size(); i++) {
      const bool first = i >= begun_;
      Result<void> added = bodies[i].there ? files_[i]->add(bodies[i], first ? frames_ : 1) : files_[i]->again();
      if (!added) return added;
    }
    begun_ = bodies.size();
    return {};
  }

  Result<void> finish() override {
    if (files_.empty())
      return Error{fmt::format("{}: there is no body to write, and no BVH file without one", printable(path_))};
    for (const auto& file : files_) {
      if (Result<void> finished = file->finish(); !finished) return finished;
    }
    if (!single_ && std::rename(folder_.c_str(), path_.c_str()) != 0) return failed();
    done_ = true;
    return {};
  }

 private:
  Error failed() const {
    return Error{fmt::format("{} can't be written: {}", printable(path_), std::generic_category().message(errno))};
  }

  std::string path_;
  double rate_;
  bool single_;
  bool done_ = false;
  std::string folder_;  // until it has its name
  UniqueNames names_;
  std::vector<std::unique_ptr<BvhFile>> files_;
  std::size_t begun_ = 0;  // bodies that were in a frame
  std::uint64_t frames_ = 0;
};

}  // namespace

Vec3 bvh_angles(const Quat& rotation, const Vec3& before) {
  const Mat3 m = glm::mat3_cast(rotation);  // m[column][row]
  const double sin_x = std::clamp(m[1][2], -1.0, 1.0);
  const double x = fixed::asin(sin_x);
  if (1 - std::abs(sin_x) < 1e-12) {
    // z and y turn about one axis: y stays, z does the rest
    const Mat3 rest = glm::mat3_cast(rotation * quat_axis({0, 1, 0}, -before.z));
    return {nearest_turn(fixed::atan2(rest[0][1], rest[0][0]), before.x), nearest_turn(x, before.y), before.z};
  }
  const Vec3 angles(fixed::atan2(-m[1][0], m[1][1]), x, fixed::atan2(-m[0][2], m[2][2]));
  const auto near = [&](const Vec3& a) {
    return Vec3(nearest_turn(a.x, before.x), nearest_turn(a.y, before.y), nearest_turn(a.z, before.z));
  };
  const Vec3 one = near(angles);
  const Vec3 other = near({angles.x + kPi, kPi - angles.y, angles.z + kPi});
  return glm::length(one - before) <= glm::length(other - before) ? one : other;
}

Result<std::unique_ptr<MotionWriter>> write_bvh(const std::string& path, double rate) {
  auto writer = std::make_unique<BvhWriter>(path, rate);
  if (const Result<void> begun = writer->begin(); !begun) return Error{begun.error()};
  return std::unique_ptr<MotionWriter>(std::move(writer));
}

}  // namespace limber
