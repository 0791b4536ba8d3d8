// Compares the MJCF reader with MuJoCo: on own models of the usual kinds, and on public ones where they are present.
#include "mjcf_reference.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "files.h"
#include "mjcf_models.h"
#include "support/skip.h"

namespace limber::model {
namespace {

using test::compare_with_mujoco;
using test::MujocoComparison;

TEST(MjcfReference, AgreesOnTheUsualModels) {
  const test::Files files;
  for (const test::MjcfModel& model : test::kMjcfModels) {
    const std::string path = files.write(std::string(model.name) + ".xml", std::string(model.text));
    const MujocoComparison result = compare_with_mujoco(path);
    EXPECT_EQ(result.rejected, "") << model.name;
    EXPECT_EQ(result.differences, std::vector<std::string>()) << model.name;
    EXPECT_GT(result.masses, 1) << model.name;
  }
}

TEST(MjcfReference, AgreesOnPublicModels) {
  namespace fs = std::filesystem;
  const char* const folder = std::getenv("LIMBER_MJCF_MODELS");
  LIMBER_SKIP_IF(folder == nullptr, "LIMBER_MJCF_MODELS names no folder with MJCF files; AgreesOnTheUsualModels runs");
  int files = 0, bodies = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".xml") continue;
    const MujocoComparison result = compare_with_mujoco(entry.path().string());
    if (!result.rejected.empty()) continue;
    std::string text;
    for (const std::string& difference : result.differences) text += difference + "\n";
    EXPECT_EQ(text, "") << entry.path();
    files++;
    bodies += result.bodies;
  }
  RecordProperty("files", files);
  RecordProperty("bodies", bodies);
  fmt::print("{} files, {} bodies\n", files, bodies);
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace limber::model
