// Files of presets on the disk: whole or not at all, and nothing that was there is lost.
#include "engine/preset_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "base/random.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

struct PresetFileTest : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / fmt::format("limber_presets_{}", getpid());
  std::string path = (folder / "scene.presets.json").string();

  PresetFileTest() { fs::create_directories(folder); }
  ~PresetFileTest() override { fs::remove_all(folder); }

  void write(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }
  static std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  // a preset whose values are all `value`
  static PresetList list_of(double value, int things = 1) {
    PresetBuilder builder;
    for (int i = 0; i < things; i++) {
      PresetClass rows;
      rows.add({"x", RowType::number, 1, {}});
      builder.give(builder.thing(fmt::format("/physics/body/b{}", i)), std::move(rows), {value});
    }
    return {builder.finish("only", {})};
  }
  static std::string saved(PresetFile& file, const PresetList& list) {
    std::string said;
    const Result<void> done = file.save(list, said);
    return done ? said : "error: " + done.error();
  }
};

TEST_F(PresetFileTest, StandsBesideTheScene) {
  EXPECT_EQ(PresetFile::beside("scripts/arms.lua"), "scripts/arms.presets.json");
  EXPECT_EQ(PresetFile::beside("/a.b/show"), "/a.b/show.presets.json");
}

TEST_F(PresetFileTest, NoFileHoldsNothing) {
  PresetFile file(path);
  EXPECT_TRUE(file.load()->presets.empty());
  EXPECT_EQ(saved(file, list_of(1)), "");
  EXPECT_EQ(saved(file, list_of(2)), "");
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json"}));
  EXPECT_EQ(PresetFile(path).load()->presets.at(0)->values, (std::vector<double>{2}));
}

TEST_F(PresetFileTest, WhatCantBeReadIsSetAside) {
  write("{ \"limber presets\": 7 }");
  PresetFile file(path);
  const Result<PresetsRead> read = file.load();
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error(), path + ": it is of version 7, which this Limber does not know; a newer one has written it");
  EXPECT_EQ(saved(file, list_of(1)), path + ": what stood there is kept as scene.presets.json.old");
  EXPECT_EQ(content(path + ".old"), "{ \"limber presets\": 7 }");
  EXPECT_EQ(saved(file, list_of(2)), "") << "once";
  write("half {");
  EXPECT_EQ(saved(file, list_of(3)), path + ": what stood there is kept as scene.presets.json.old-2")
      << "another hand has written it meanwhile";
  EXPECT_EQ(content(path + ".old-2"), "half {");
  EXPECT_EQ(PresetFile(path).load()->presets.at(0)->values, (std::vector<double>{3}));
}

TEST_F(PresetFileTest, WhatWasLeftOutIsSetAsideToo) {
  write(R"({ "limber presets": 1, "presets": [ { "name": "a", "values": { "/scene": { "x": null, "y": 1 } } } ] })");
  PresetFile file(path);
  const Result<PresetsRead> read = file.load();
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->problems,
            (std::vector<std::string>{path + ": preset 'a', /scene: 'x' has no value that any row has"}));
  EXPECT_EQ(saved(file, read->presets), path + ": what stood there is kept as scene.presets.json.old");
}

TEST_F(PresetFileTest, AFullDiskLosesNothing) {
  PresetFile file(path);
  EXPECT_EQ(saved(file, list_of(1)), "");
  const std::string before = content(path);
  // the system refuses more than 4 KB of a file, as a full disk does
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto signal_before = signal(SIGXFSZ, SIG_IGN);
  const rlimit little{4096, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  const std::string said = saved(file, list_of(2, 1000));
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, signal_before);
  EXPECT_EQ(said, "error: the presets could not be saved: File too large");
  EXPECT_EQ(content(path), before);
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json"})) << "and nothing half is left";
  EXPECT_EQ(saved(file, list_of(2, 1000)), "") << "there is room again";
}

TEST_F(PresetFileTest, AFolderThatIsGone) {
  PresetFile file((folder / "gone" / "x.presets.json").string());
  EXPECT_TRUE(file.load().ok());
  EXPECT_EQ(saved(file, list_of(1)), "error: the presets could not be saved: No such file or directory");
}

TEST_F(PresetFileTest, MoreThanItTakesIsNotRead) {
  write("");
  fs::resize_file(path, std::uintmax_t{300} << 20u);  // without blocks on the disk
  const Result<PresetsRead> read = PresetFile(path).load();
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error(), path + ": 300 MB are more than presets take (256 MB)");
}

TEST_F(PresetFileTest, ALinkAndTheModeStay) {
  const std::string real = (folder / "real.json").string();
  std::ofstream(real) << text_of(PresetList{});
  fs::create_symlink("real.json", path);
  chmod(real.c_str(), 0600);
  PresetFile file(path);
  ASSERT_TRUE(file.load().ok());
  EXPECT_EQ(saved(file, list_of(4)), "");
  EXPECT_TRUE(fs::is_symlink(path));
  EXPECT_EQ(PresetFile(real).load()->presets.at(0)->values, (std::vector<double>{4}));
  struct stat info {};
  ASSERT_EQ(stat(real.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0600u);
}

TEST_F(PresetFileTest, NothingIsWrittenThroughALinkOutOfTheShow) {
  const fs::path show = folder / "show";
  fs::create_directories(show / "scripts");
  const std::string scene = (show / "scripts/scene.lua").string();
  path = PresetFile::beside(scene);
  const std::string presets = text_of(list_of(1));
  const auto save_over = [&](const fs::path& target, const std::string& text) {
    fs::remove(path);
    fs::create_symlink(target, path);
    if (!text.empty()) std::ofstream(target, std::ios::binary) << text;
    PresetFile file(path, PresetFile::owner_of(scene, "", true));
    (void)file.load();
    return saved(file, list_of(2));
  };
  const fs::path outside = folder / "precious";
  for (const std::string& text : {presets, std::string("export PATH")}) {
    EXPECT_EQ(save_over(outside, text), "error: the presets could not be saved: it is a link to " + outside.string() +
                                            ", outside of the show's folder; put a file in its place");
    EXPECT_EQ(content(outside), text);
    EXPECT_TRUE(fs::is_symlink(path));
  }
  const fs::path inside = show / "shared.json";
  EXPECT_EQ(save_over(inside, presets), "");
  EXPECT_EQ(PresetFile(inside.string()).load()->presets.at(0)->values, (std::vector<double>{2}));
  EXPECT_EQ(save_over(inside, "-- a script"), "error: the presets could not be saved: it is a link to " +
                                                  inside.string() +
                                                  ", which is no file of presets; put a file in its place");
  EXPECT_EQ(content(inside), "-- a script");
  // a link that leads nowhere is replaced itself
  EXPECT_EQ(save_over(folder / "nothing", ""), "");
  EXPECT_FALSE(fs::exists(folder / "nothing"));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path)));
}

TEST_F(PresetFileTest, OnlyFilesAreReplaced) {
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  PresetFile file(path);
  EXPECT_FALSE(file.load().ok());
  EXPECT_EQ(saved(file, list_of(1)), "error: the presets could not be saved: it is no file");
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST_F(PresetFileTest, TheFirstProgramOwnsThem) {
  const std::string scene = (folder / "scene.lua").string();
  const std::string locks = (folder / "state/locks").string();
  const auto open = [&](bool stays) {
    auto file = std::make_unique<PresetFile>(path, PresetFile::owner_of(scene, locks, stays));
    (void)file->load();
    return file;
  };
  const std::string refused = "error: the presets could not be saved: another program plays this scene and owns them";
  auto fast = open(false);
  auto first = open(true);
  auto second = open(true);
  EXPECT_EQ(saved(*second, list_of(2)), refused);
  EXPECT_EQ(saved(*fast, list_of(3)), refused);
  EXPECT_EQ(saved(*first, list_of(1)), "");
  EXPECT_EQ(saved(*first, list_of(4)), "");
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json", "state"})) << "nothing was set aside";
  first = nullptr;
  // a program that does not hold them has them during a save alone
  EXPECT_NE(saved(*fast, list_of(5)).find("is kept as scene.presets.json.old"), std::string::npos);
  EXPECT_NE(saved(*second, list_of(6)).find("is kept as scene.presets.json.old-2"), std::string::npos);
  EXPECT_EQ(saved(*fast, list_of(7)), refused);
  EXPECT_EQ(PresetFile(path).load()->presets.at(0)->values, (std::vector<double>{6}));
  second = nullptr;
  EXPECT_TRUE(fs::is_empty(locks));
}

// killed in the middle of saves, at a moment that the kernel's timing chooses
TEST_F(PresetFileTest, KilledAtAnyMomentItIsWhole) {
  Random random(9, "kill");
  int newest = 0;
  for (int round = 0; round < 200; round++) {
    int tell[2];
    ASSERT_EQ(pipe(tell), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      PresetFile file(path);
      (void)file.load();
      std::string said;
      for (int i = newest + 1; file.save(list_of(i, 100), said); i++) {
        const char done = 1;
        if (::write(tell[1], &done, 1) != 1) break;
      }
      _exit(0);
    }
    close(tell[1]);
    const int saves = static_cast<int>(random.uniform(0, 4));
    char done = 0;
    for (int i = 0; i < saves; i++) ASSERT_EQ(::read(tell[0], &done, 1), 1);
    for (volatile int spin = static_cast<int>(random.uniform(0, 300000)); spin > 0;) spin = spin - 1;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(tell[0]);
    const Result<PresetsRead> read = PresetFile(path).load();
    ASSERT_TRUE(read.ok()) << read.error();
    ASSERT_TRUE(read->problems.empty());
    if (newest + saves == 0) continue;
    const std::vector<double>& values = read->presets.at(0)->values;
    ASSERT_EQ(values, std::vector<double>(100, values.at(0))) << "of one save";
    ASSERT_GE(values[0], newest + saves) << "what was said to be saved is there";
    newest = static_cast<int>(values[0]);
  }
  EXPECT_GT(newest, 100);
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json"})) << "leftovers of the dead are cleared";
}

}  // namespace
}  // namespace limber
