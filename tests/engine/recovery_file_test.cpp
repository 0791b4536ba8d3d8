// What is kept for a start after a crash: whole, of the newest run that did not end well, never two programs' in one.
#include "engine/recovery_file.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

namespace fs = std::filesystem;

constexpr std::time_t kThen = 1700000000;

struct RecoveryFileTest : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / fmt::format("limber_recovery_{}", getpid());
  std::string scene = (folder / "show/scene.lua").string();

  ~RecoveryFileTest() override { fs::remove_all(folder); }

  std::unique_ptr<RecoveryFile> open() const {
    return std::move(*RecoveryFile::open((folder / "state").string(), scene));
  }
  std::vector<std::string> files() const {
    std::vector<std::string> endings;
    for (const auto& entry : fs::directory_iterator(folder / "state")) {
      const std::string name = entry.path().filename().string();
      endings.push_back(name.substr(name.find('.')));
    }
    std::ranges::sort(endings);
    return endings;
  }
  fs::path only(const std::string& ending) const {
    for (const auto& entry : fs::directory_iterator(folder / "state")) {
      if (entry.path().filename().string().ends_with(ending)) return entry.path();
    }
    return {};
  }
};

PresetRow number_row(const std::string& name) { return {name, RowType::number, 1, {}}; }

// things of one class with rows x and y
std::shared_ptr<const Preset> numbers(const std::vector<std::pair<std::string, std::vector<double>>>& things) {
  PresetBuilder builder;
  for (const auto& [path, values] : things) {
    PresetClass rows;
    rows.add(number_row("x"));
    rows.add(number_row("y"));
    builder.give(builder.thing(path), std::move(rows), values);
  }
  return builder.finish("p", {});
}

double value_of(const LostValues& lost) { return lost.values->values.at(0); }

TEST(ChangedValues, AreTheRowsThatTheSceneDoesNotSayAlike) {
  const auto script = numbers({{"/a", {1, 2}}, {"/b", {3, 4}}, {"/gone", {5, 6}}});
  const auto now = numbers({{"/b", {3, 4.5}}, {"/came", {7, 8}}, {"/a", {1, 2}}});
  const auto changed = changed_values(*now, *script);
  ASSERT_NE(changed, nullptr);
  EXPECT_EQ(changed->values, (std::vector<double>{4.5, 7, 8}));
  EXPECT_EQ(changed->shape->row_count(), 3);
  EXPECT_EQ(changed_values(*script, *script), nullptr);
}

TEST(ChangedValues, ChoicesAreComparedByTheirWords) {
  const auto of = [](std::vector<std::string> labels, double value) {
    PresetBuilder builder;
    PresetClass rows;
    rows.add({"mode", RowType::choice, 1, std::move(labels)});
    builder.give(builder.thing("/a"), std::move(rows), {value});
    return builder.finish("p", {});
  };
  EXPECT_EQ(changed_values(*of({"on", "off"}, 1), *of({"off", "on"}, 0)), nullptr);
  EXPECT_NE(changed_values(*of({"on", "off"}, 1), *of({"off", "on"}, 1)), nullptr);
}

TEST_F(RecoveryFileTest, WhatARunLeftThatWasKilledIsThereUntilItWasBroughtBack) {
  {
    const auto file = open();
    EXPECT_FALSE(file->lost()->has_value());
    ASSERT_TRUE(file->save(numbers({{"/a", {0.1, 2}}}), kThen).ok());
    ASSERT_TRUE(file->save(numbers({{"/a", {0.2, 2}}}), kThen + 5).ok());
  }  // without end(): as a kill leaves it
  for (int i = 0; i < 2; i++) {
    const auto file = open();
    const auto lost = *file->lost();
    ASSERT_TRUE(lost.has_value());
    EXPECT_EQ(value_of(*lost), 0.2);
    EXPECT_EQ(lost->saved, kThen + 5);
    file->end(false);  // nobody has asked for it
  }
  open()->end(true);
  EXPECT_TRUE(files().empty());
}

TEST_F(RecoveryFileTest, TheNewestLostValuesCount) {
  ASSERT_TRUE(open()->save(numbers({{"/a", {1, 2}}}), kThen).ok());
  const auto second = open();
  EXPECT_EQ(value_of(**second->lost()), 1);
  ASSERT_TRUE(second->save(numbers({{"/a", {3, 2}}}), kThen).ok());
  EXPECT_EQ(value_of(**second->lost()), 1) << "until that run is over";
}

TEST_F(RecoveryFileTest, ARunThatDidNotSaveKeepsWhatWasLostBefore) {
  ASSERT_TRUE(open()->save(numbers({{"/a", {1, 2}}}), kThen).ok());
  (void)open();
  EXPECT_EQ(value_of(**open()->lost()), 1);
}

TEST_F(RecoveryFileTest, TheFirstProgramThatPlaysASceneOwnsItsFile) {
  auto first = open();
  ASSERT_TRUE(first->save(numbers({{"/a", {1, 0}}}), kThen).ok());
  EXPECT_EQ(open(), nullptr);
  const std::string same = scene;
  scene = (folder / "show/../show/scene.lua").string();
  EXPECT_EQ(open(), nullptr) << "by another path";
  scene = (folder / "other/scene.lua").string();
  EXPECT_FALSE(open()->lost()->has_value()) << "of another folder";
  scene = same;
  first = nullptr;  // killed
  EXPECT_EQ(value_of(**open()->lost()), 1);
}

TEST_F(RecoveryFileTest, ACleanEndLeavesNothing) {
  const auto file = open();
  ASSERT_TRUE(file->save(numbers({{"/a", {1, 0}}}), kThen).ok());
  EXPECT_EQ(files(), (std::vector<std::string>{".json", ".lock"}));
  ASSERT_TRUE(file->save(nullptr, kThen).ok());
  EXPECT_EQ(files(), (std::vector<std::string>{".lock"})) << "everything is as the scene says again";
  ASSERT_TRUE(file->save(numbers({{"/a", {1, 0}}}), kThen).ok());
  file->end(false);
  EXPECT_TRUE(files().empty());
}

TEST_F(RecoveryFileTest, DamageIsSaidAndStays) {
  ASSERT_TRUE(open()->save(numbers({{"/a", {1, 2}}}), kThen).ok());
  const auto file = open();
  const fs::path lost = only(".lost.json");
  std::ifstream in(lost, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{10}, whole.find('\n'), whole.size() / 2, whole.size() - 3}) {
    std::ofstream(lost, std::ios::binary) << whole.substr(0, size);
    const auto read = file->lost();
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_TRUE(read.error().starts_with(lost.string() + ": ")) << read.error();
    EXPECT_TRUE(fs::exists(lost));
  }
}

TEST_F(RecoveryFileTest, AFolderThatCanNotBeIsAnError) {
  fs::create_directories(folder);
  std::ofstream(folder / "state") << "a file";
  const auto file = RecoveryFile::open((folder / "state").string(), scene);
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().find("state"), std::string::npos);
}

}  // namespace
}  // namespace limber
