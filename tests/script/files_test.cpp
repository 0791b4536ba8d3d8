// Where a scene's files are found.
#include <gtest/gtest.h>

#include "script/files.h"
#include "script/sources.h"
#include "stage.h"

namespace limber {
namespace {

TEST(Files, TheShowIsTheNearestFolderWithScripts) {
  Stage stage;
  stage.write("show/scripts/deep/scene.lua", "");
  stage.write("show/other/scene.lua", "");
  const auto show = [&](const std::string& scene) {
    return ScriptFiles((stage.folder / scene).string(), "").show_folder();
  };
  EXPECT_EQ(show("show/scripts/deep/scene.lua"), (stage.folder / "show").string());
  EXPECT_EQ(show("show/other/scene.lua"), (stage.folder / "show").string());
  EXPECT_EQ(show("scene.lua"), stage.folder.string());
  EXPECT_EQ(ScriptFiles("/nowhere/at/all.lua", "").show_folder(), "/nowhere/at");
}

TEST(Files, TheNearerFileWinsAndInstalledDataComesLast) {
  Stage stage;
  stage.write("data/urdf/a.urdf", "");
  stage.write("data/urdf/b.urdf", "");
  stage.write("show/urdf/b.urdf", "");
  stage.write("show/scripts/urdf/c.urdf", "");
  stage.write("show/urdf/c.urdf", "");
  const ScriptFiles files((stage.folder / "show/scripts/scene.lua").string(), (stage.folder / "data").string());
  EXPECT_EQ(files.find("urdf/a.urdf").value(), (stage.folder / "data/urdf/a.urdf").string());
  EXPECT_EQ(files.find("urdf/b.urdf").value(), (stage.folder / "show/urdf/b.urdf").string());
  EXPECT_EQ(files.find("urdf/c.urdf").value(), (stage.folder / "show/scripts/urdf/c.urdf").string());
  EXPECT_EQ(files.find((stage.folder / "data/urdf/b.urdf").string()).value(),
            (stage.folder / "data/urdf/b.urdf").string());
  EXPECT_FALSE(files.find("urdf").ok());  // a folder is no file
  EXPECT_FALSE(files.find("").ok());
}

TEST(Files, NamesAreShownFromTheShowOn) {
  Stage stage;
  stage.write("show/scripts/scene.lua", "");
  const ScriptFiles files((stage.folder / "show/scripts/scene.lua").string(), "");
  EXPECT_EQ(files.shown((stage.folder / "show/scripts/scene.lua").string()), "scripts/scene.lua");
  EXPECT_EQ(files.shown("/etc/hosts"), "/etc/hosts");
}

TEST(Files, AScriptHasAtMostAMegabyte) {
  Stage stage;
  stage.write("big.lua", std::string((1u << 20) + 1, ' '));
  stage.write("bom.lua", "\xef\xbb\xbfprint(1)");
  EXPECT_NE(read_script((stage.folder / "big.lua").string()).error().find("a script may have 1 MB"), std::string::npos);
  EXPECT_EQ(Sources().text((stage.folder / "bom.lua").string()).value(), "print(1)");
}

}  // namespace
}  // namespace limber
