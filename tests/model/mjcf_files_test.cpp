// MJCF files that include others.
#include <string>

#include <gtest/gtest.h>

#include "files.h"
#include "import_text.h"
#include "model/import.h"
#include "model/model_library.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::has_problem;

TEST(MjcfFiles, IncludesFilesAndReportsTheirLines) {
  const test::Files files;
  files.write("parts/leg.xml",
              "<mujocoinclude>\n<body name='leg'><joint/>\n<geom size='.1' typ='box'/></body></mujocoinclude>");
  const std::string path = files.write("model.xml",
                                       "<mujoco><worldbody>\n<body name='t'><freejoint/><geom size='.1'/>\n<include "
                                       "file='parts/leg.xml'/></body></worldbody></mujoco>");
  const auto model = import_model(path);
  ASSERT_TRUE(model) << model.error();
  ASSERT_EQ((*model)->links.size(), 2u) << all_problems(**model);
  EXPECT_TRUE(has_problem(**model, Severity::warning, "leg.xml line 3: <geom> has no attribute 'typ'; ignored", 3))
      << all_problems(**model);
  ASSERT_EQ((*model)->files.size(), 2u);
  EXPECT_TRUE((*model)->files[1].ends_with("parts/leg.xml"));
  EXPECT_NE((*model)->file_hashes[1], 0u);
}

TEST(MjcfFiles, LibraryReadsItAgainWhenAnIncludedFileChanges) {
  const test::Files files;
  files.write("leg.xml", "<mujoco><body name='leg'><joint/><geom size='.1'/></body></mujoco>");
  const std::string path = files.write(
      "model.xml",
      "<mujoco><worldbody><body name='t'><geom size='.1'/><include file='leg.xml'/></body></worldbody></mujoco>");
  ModelLibrary library;
  const auto before = library.load(path);
  ASSERT_TRUE(before);
  EXPECT_EQ(library.load(path).value(), *before);
  files.write("leg.xml", "<mujoco><body name='longleg'><joint/><geom size='.1'/></body></mujoco>");
  const auto after = library.load(path);
  ASSERT_TRUE(after);
  EXPECT_EQ((*after)->links.back().name, "longleg");
}

}  // namespace
}  // namespace limber::model
