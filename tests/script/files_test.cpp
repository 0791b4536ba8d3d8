// The search for a scene's files.
#include <gtest/gtest.h>

#include "script/scene/script_files.h"
#include "script/scene/sources.h"
#include "stage.h"

namespace limber::script {
namespace {

TEST(Files, TheShowFolderIsTheNearestWithScripts) {
  ScriptFixture fixture;
  fixture.write("show/scripts/deep/scene.lua", "");
  fixture.write("show/other/scene.lua", "");
  const auto show = [&](const std::string& scene) {
    return ScriptFiles((fixture.folder / scene).string(), "").show_folder();
  };
  EXPECT_EQ(show("show/scripts/deep/scene.lua"), (fixture.folder / "show").string());
  EXPECT_EQ(show("show/other/scene.lua"), (fixture.folder / "show").string());
  EXPECT_EQ(show("scene.lua"), fixture.folder.string());
  EXPECT_EQ(ScriptFiles("/nowhere/at/all.lua", "").show_folder(), "/nowhere/at");
}

TEST(Files, TheNearerFileWinsAndInstalledDataComesLast) {
  ScriptFixture fixture;
  fixture.write("data/urdf/a.urdf", "");
  fixture.write("data/urdf/b.urdf", "");
  fixture.write("show/urdf/b.urdf", "");
  fixture.write("show/scripts/urdf/c.urdf", "");
  fixture.write("show/urdf/c.urdf", "");
  const ScriptFiles files((fixture.folder / "show/scripts/scene.lua").string(), (fixture.folder / "data").string());
  EXPECT_EQ(files.find("urdf/a.urdf").value(), (fixture.folder / "data/urdf/a.urdf").string());
  EXPECT_EQ(files.find("urdf/b.urdf").value(), (fixture.folder / "show/urdf/b.urdf").string());
  EXPECT_EQ(files.find("urdf/c.urdf").value(), (fixture.folder / "show/scripts/urdf/c.urdf").string());
  EXPECT_EQ(files.find((fixture.folder / "data/urdf/b.urdf").string()).value(),
            (fixture.folder / "data/urdf/b.urdf").string());
  EXPECT_FALSE(files.find("urdf").ok());  // a folder is not a file
  EXPECT_FALSE(files.find("").ok());
}

TEST(Files, NamesAreRelativeToTheShow) {
  ScriptFixture fixture;
  fixture.write("show/scripts/scene.lua", "");
  const ScriptFiles files((fixture.folder / "show/scripts/scene.lua").string(), "");
  EXPECT_EQ(files.display_path((fixture.folder / "show/scripts/scene.lua").string()), "scripts/scene.lua");
  EXPECT_EQ(files.display_path("/etc/hosts"), "/etc/hosts");
}

TEST(Files, AScriptHasAtMostAMegabyte) {
  ScriptFixture fixture;
  fixture.write("big.lua", std::string((1u << 20) + 1, ' '));
  fixture.write("bom.lua", "\xef\xbb\xbfprint(1)");
  EXPECT_NE(read_script((fixture.folder / "big.lua").string()).error().find("a script can have at most 1 MB"),
            std::string::npos);
  EXPECT_EQ(Sources().text((fixture.folder / "bom.lua").string()).value(), "print(1)");
}

}  // namespace
}  // namespace limber::script
