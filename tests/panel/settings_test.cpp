// Persistent settings: round trip, damaged content, files.
#include "ui/panel/settings.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limber::panel {
namespace {

namespace fs = std::filesystem;

GuiSettings own_settings() {
  GuiSettings settings;
  settings.text_size = 21;
  settings.hidden = true;
  settings.morph_seconds = 0.25;
  settings.easing = 2;
  settings.favorites = {"/physics/sim/gravity", "/scene/größe"};
  settings.keys = {{"panic", "F9"}};
  settings.style = "studio";
  settings.full_screen = settings.hide_pointer = true;
  settings.monitor = "DP-1";
  settings.window_width = 1500;
  settings.window_height = 800;
  return settings;
}

TEST(Settings, RoundTrip) {
  const Result<GuiSettings> back = read_settings(settings_text(own_settings()));
  ASSERT_TRUE(back.ok()) << back.error();
  EXPECT_EQ(*back, own_settings());
}

TEST(Settings, RepairsMissingAndInvalidValues) {
  EXPECT_EQ(*read_settings("{}"), GuiSettings());
  EXPECT_EQ(read_settings(R"({"text_size": 400})")->text_size, 28);
  EXPECT_EQ(read_settings(R"({"text_size": "big", "favourites": [1, "/a", null]})")->text_size, 16);
  EXPECT_EQ(read_settings(R"({"favourites": [1, "/a", null]})")->favorites, std::set<std::string>{"/a"});
  EXPECT_EQ(read_settings(R"({"keys": {"panic": "F9", "step": 3}})")->keys,
            (std::map<std::string, std::string>{{"panic", "F9"}}));
  EXPECT_EQ(read_settings(R"({"window_width": -1e30})")->window_width, 0);
  EXPECT_FALSE(read_settings("").ok());
  EXPECT_FALSE(read_settings("[1]").ok());
  EXPECT_FALSE(read_settings("{\"text_size\": 1").ok());
}

TEST(Settings, RenamesDamagedFile) {
  const fs::path folder = fs::path(::testing::TempDir()) / fmt::format("limber_settings_{}", ::getpid());
  const std::string file = (folder / "limber" / "panel.json").string();
  EXPECT_EQ(load_settings(file), GuiSettings()) << "there is none yet";
  save_settings(file, own_settings());
  EXPECT_EQ(load_settings(file), own_settings());
  std::ofstream(file) << "{ \"text_size\": 2";
  EXPECT_EQ(load_settings(file), GuiSettings());
  EXPECT_FALSE(fs::exists(file));
  EXPECT_TRUE(fs::exists(file + ".damaged")) << "nothing is lost";
  save_settings(file, own_settings());
  EXPECT_EQ(load_settings(file), own_settings());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace limber::panel
