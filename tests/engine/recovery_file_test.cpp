// Recovery files: complete, of the latest run that crashed, owned by one program.
#include "engine/recovery/recovery_file.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limber::engine {
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
  fs::path file_with_ending(const std::string& ending) const {
    for (const auto& entry : fs::directory_iterator(folder / "state")) {
      if (entry.path().filename().string().ends_with(ending)) return entry.path();
    }
    return {};
  }
};

PresetProperty number_property(const std::string& name) { return {name, PropertyType::number, 1, {}}; }

// a preset of nodes with the properties x and y
std::shared_ptr<const Preset> numbers(const std::vector<std::pair<std::string, std::vector<double>>>& nodes) {
  PresetBuilder builder;
  for (const auto& [path, values] : nodes) {
    PresetLayout layout;
    layout.add(number_property("x"));
    layout.add(number_property("y"));
    builder.add(path, std::move(layout), values);
  }
  return builder.finish("p", {});
}

double value_of(const RecoverableValues& lost) { return lost.values->values.at(0); }

TEST(ChangedValues, AreThoseThatDifferFromTheScene) {
  const auto script = numbers({{"/a", {1, 2}}, {"/b", {3, 4}}, {"/gone", {5, 6}}});
  const auto now = numbers({{"/b", {3, 4.5}}, {"/came", {7, 8}}, {"/a", {1, 2}}});
  const auto changed = changed_values(*now, *script);
  ASSERT_NE(changed, nullptr);
  EXPECT_EQ(changed->values, (std::vector<double>{4.5, 7, 8}));
  EXPECT_EQ(changed->schema->property_count(), 3);
  EXPECT_EQ(changed_values(*script, *script), nullptr);
}

TEST(ChangedValues, ComparesChoicesByLabel) {
  const auto choice_preset = [](std::vector<std::string> labels, double value) {
    PresetBuilder builder;
    PresetLayout layout;
    layout.add({"mode", PropertyType::choice, 1, std::move(labels)});
    builder.add("/a", std::move(layout), {value});
    return builder.finish("p", {});
  };
  EXPECT_EQ(changed_values(*choice_preset({"on", "off"}, 1), *choice_preset({"off", "on"}, 0)), nullptr);
  EXPECT_NE(changed_values(*choice_preset({"on", "off"}, 1), *choice_preset({"off", "on"}, 1)), nullptr);
}

TEST_F(RecoveryFileTest, KeepsValuesOfAKilledRunUntilRestored) {
  {
    const auto file = open();
    EXPECT_FALSE(file->recoverable()->has_value());
    ASSERT_TRUE(file->save(numbers({{"/a", {0.1, 2}}}), kThen).ok());
    ASSERT_TRUE(file->save(numbers({{"/a", {0.2, 2}}}), kThen + 5).ok());
  }  // without end(), as after a crash
  for (int i = 0; i < 2; i++) {
    const auto file = open();
    const auto recoverable = *file->recoverable();
    ASSERT_TRUE(recoverable.has_value());
    EXPECT_EQ(value_of(*recoverable), 0.2);
    EXPECT_EQ(recoverable->saved_at, kThen + 5);
    file->end(false);  // not restored
  }
  open()->end(true);
  EXPECT_TRUE(files().empty());
}

TEST_F(RecoveryFileTest, OffersTheLatestValues) {
  ASSERT_TRUE(open()->save(numbers({{"/a", {1, 2}}}), kThen).ok());
  const auto second = open();
  EXPECT_EQ(value_of(**second->recoverable()), 1);
  ASSERT_TRUE(second->save(numbers({{"/a", {3, 2}}}), kThen).ok());
  EXPECT_EQ(value_of(**second->recoverable()), 1) << "until that run has ended";
}

TEST_F(RecoveryFileTest, ARunWithoutSaveKeepsOlderValues) {
  ASSERT_TRUE(open()->save(numbers({{"/a", {1, 2}}}), kThen).ok());
  (void)open();
  EXPECT_EQ(value_of(**open()->recoverable()), 1);
}

TEST_F(RecoveryFileTest, TheFirstProgramOwnsTheFile) {
  auto first = open();
  ASSERT_TRUE(first->save(numbers({{"/a", {1, 0}}}), kThen).ok());
  EXPECT_EQ(open(), nullptr);
  const std::string same = scene;
  scene = (folder / "show/../show/scene.lua").string();
  EXPECT_EQ(open(), nullptr) << "by another path";
  scene = (folder / "other/scene.lua").string();
  EXPECT_FALSE(open()->recoverable()->has_value()) << "of another folder";
  scene = same;
  first = nullptr;  // killed
  EXPECT_EQ(value_of(**open()->recoverable()), 1);
}

TEST_F(RecoveryFileTest, ACleanExitLeavesNoFile) {
  const auto file = open();
  ASSERT_TRUE(file->save(numbers({{"/a", {1, 0}}}), kThen).ok());
  EXPECT_EQ(files(), (std::vector<std::string>{".json", ".lock"}));
  ASSERT_TRUE(file->save(nullptr, kThen).ok());
  EXPECT_EQ(files(), (std::vector<std::string>{".lock"})) << "all values equal those of the scene";
  ASSERT_TRUE(file->save(numbers({{"/a", {1, 0}}}), kThen).ok());
  file->end(false);
  EXPECT_TRUE(files().empty());
}

TEST_F(RecoveryFileTest, ReportsDamageAndKeepsTheFile) {
  ASSERT_TRUE(open()->save(numbers({{"/a", {1, 2}}}), kThen).ok());
  const auto file = open();
  const fs::path lost_file = file_with_ending(".lost.json");
  std::ifstream in(lost_file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{10}, whole.find('\n'), whole.size() / 2, whole.size() - 3}) {
    std::ofstream(lost_file, std::ios::binary) << whole.substr(0, size);
    const auto read = file->recoverable();
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_TRUE(read.error().starts_with(lost_file.string() + ": ")) << read.error();
    EXPECT_TRUE(fs::exists(lost_file));
  }
}

TEST_F(RecoveryFileTest, ReportsAFolderThatCannotBeCreated) {
  fs::create_directories(folder);
  std::ofstream(folder / "state") << "a file";
  const auto file = RecoveryFile::open((folder / "state").string(), scene);
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.error().find("state"), std::string::npos);
}

}  // namespace
}  // namespace limber::engine
