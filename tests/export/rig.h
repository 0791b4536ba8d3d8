// Test fixtures: a body of three links that moves by formulas, a folder for exported files, and a simulated full disk.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "export/motion.h"

namespace limber::exporter::test {

class MotionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("limber_motion_") + info->name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<std::string> files(const std::string& below = ".") const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / below))
      all.push_back(entry.path().filename());
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  std::filesystem::path folder_;
};

/// A triangle in the link's frame.
inline std::shared_ptr<const Surfaces> triangle(const Vec3& color, double alpha = 1) {
  Surface s;
  s.points = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0, 0.3F}};
  s.normals = {{0, -1, 0}, {0, -1, 0}, {0, -1, 0}};
  s.triangles = {0, 1, 2};
  s.color = color;
  s.alpha = alpha;
  return std::make_shared<const Surfaces>(Surfaces{s});
}

/// A base, an arm 0.5 m above it rotated by 90 degrees about x, and a tip 0.3 m along the arm's x axis.
inline MotionBody three_links(const std::string& name, const std::shared_ptr<const Surfaces>& seen = nullptr) {
  const Pose arm{{0, 0, 0.5}, quat_axis({1, 0, 0}, kPi / 2)};
  return {name,
          {{"base", -1, {}, seen}, {"arm", 0, arm, seen}, {"tip", 1, arm * Pose{{0.3, 0, 0}}, nullptr}},
          {{"shoulder", {"angle"}}, {"wrist", {"angle"}}}};
}

/// That body with these joint angles (rad), the base at `at`.
inline MotionSample posed(double shoulder, double wrist, const Vec3& at = {1, 2, 3}, double heading = 0.4) {
  const MotionBody body = three_links("");
  const Pose base{at, quat_axis({0, 0, 1}, heading)};
  const Pose arm = base * body.links[1].rest * Pose{{0, 0, 0}, quat_axis({0, 0, 1}, shoulder)};
  const Pose tip = arm * Pose{{0.3, 0, 0}} * Pose{{0, 0, 0}, quat_axis(glm::normalize(Vec3(1, 2, -1)), wrist)};
  return {true, {base, arm, tip}, {shoulder, wrist}};
}

inline MotionSample absent() { return {}; }

/// Limits the size of files during its lifetime, to simulate a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : previous_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &previous_limit_);
    const rlimit lowered{bytes, previous_limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &lowered);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &previous_limit_);
    std::signal(SIGXFSZ, previous_handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*previous_handler_)(int);
  rlimit previous_limit_{};
};

inline std::unique_ptr<MotionWriter> opened(Result<std::unique_ptr<MotionWriter>> writer) {
  EXPECT_TRUE(writer) << writer.error();
  return std::move(*writer);
}

inline std::string error_text(const Result<void>& result) { return result ? "" : result.error(); }

}  // namespace limber::exporter::test
