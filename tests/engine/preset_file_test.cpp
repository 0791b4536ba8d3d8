// Preset files on the disk: atomic replacement, and backups of content that would be lost.
#include "engine/presets/file.h"

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

namespace limber::engine {
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
  // a list with one preset, with all its values equal to `value`
  static PresetList list_of(double value, int node_count = 1) {
    PresetBuilder builder;
    for (int i = 0; i < node_count; i++) {
      PresetLayout layout;
      layout.add({"x", PropertyType::number, 1, {}});
      builder.add(fmt::format("/physics/body/b{}", i), std::move(layout), {value});
    }
    return {builder.finish("only", {})};
  }
  static std::string saved(PresetFile& file, const PresetList& list) {
    std::string notice;
    const Result<void> done = file.save(list, notice);
    return done ? notice : "error: " + done.error();
  }
};

TEST_F(PresetFileTest, IsNextToTheScene) {
  EXPECT_EQ(PresetFile::path_for("scripts/arms.lua"), "scripts/arms.presets.json");
  EXPECT_EQ(PresetFile::path_for("/a.b/show"), "/a.b/show.presets.json");
}

TEST_F(PresetFileTest, AMissingFileHasNoPresets) {
  PresetFile file(path);
  EXPECT_TRUE(file.load()->presets.empty());
  EXPECT_EQ(saved(file, list_of(1)), "");
  EXPECT_EQ(saved(file, list_of(2)), "");
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json"}));
  EXPECT_EQ(PresetFile(path).load()->presets.at(0)->values, (std::vector<double>{2}));
}

TEST_F(PresetFileTest, BacksUpAnUnreadableFile) {
  write("{ \"limber presets\": 7 }");
  PresetFile file(path);
  const Result<ParsedPresets> read = file.load();
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error(), path + ": version 7 is not supported; a newer Limber has written it");
  EXPECT_EQ(saved(file, list_of(1)), path + ": the previous file was backed up as scene.presets.json.old");
  EXPECT_EQ(content(path + ".old"), "{ \"limber presets\": 7 }");
  EXPECT_EQ(saved(file, list_of(2)), "") << "once";
  write("half {");
  EXPECT_EQ(saved(file, list_of(3)), path + ": the previous file was backed up as scene.presets.json.old-2")
      << "another program has written it meanwhile";
  EXPECT_EQ(content(path + ".old-2"), "half {");
  EXPECT_EQ(PresetFile(path).load()->presets.at(0)->values, (std::vector<double>{3}));
}

TEST_F(PresetFileTest, BacksUpAFileWithSkippedValues) {
  write(R"({ "limber presets": 1, "presets": [ { "name": "a", "values": { "/scene": { "x": null, "y": 1 } } } ] })");
  PresetFile file(path);
  const Result<ParsedPresets> read = file.load();
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->problems,
            (std::vector<std::string>{path + ": preset 'a', /scene: 'x' has a value of no known type"}));
  EXPECT_EQ(saved(file, read->presets), path + ": the previous file was backed up as scene.presets.json.old");
}

TEST_F(PresetFileTest, AFullDiskLosesNothing) {
  PresetFile file(path);
  EXPECT_EQ(saved(file, list_of(1)), "");
  const std::string before = content(path);
  // the system rejects files of more than 4 KB, like a full disk
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto signal_before = signal(SIGXFSZ, SIG_IGN);
  const rlimit small_limit{4096, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small_limit);
  const std::string notice = saved(file, list_of(2, 1000));
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, signal_before);
  EXPECT_EQ(notice, "error: the presets could not be saved: File too large");
  EXPECT_EQ(content(path), before);
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json"})) << "no partial file is left";
  EXPECT_EQ(saved(file, list_of(2, 1000)), "") << "there is space again";
}

TEST_F(PresetFileTest, ReportsAMissingFolder) {
  PresetFile file((folder / "gone" / "x.presets.json").string());
  EXPECT_TRUE(file.load().ok());
  EXPECT_EQ(saved(file, list_of(1)), "error: the presets could not be saved: No such file or directory");
}

TEST_F(PresetFileTest, RejectsATooLargeFile) {
  write("");
  fs::resize_file(path, std::uintmax_t{300} << 20u);  // without blocks on the disk
  const Result<ParsedPresets> read = PresetFile(path).load();
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error(), path + ": the file of 300 MB exceeds the limit of 256 MB");
}

TEST_F(PresetFileTest, KeepsLinkAndMode) {
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

TEST_F(PresetFileTest, NeverWritesThroughALinkOutOfTheShow) {
  const fs::path show = folder / "show";
  fs::create_directories(show / "scripts");
  const std::string scene = (show / "scripts/scene.lua").string();
  path = PresetFile::path_for(scene);
  const std::string presets = text_of(list_of(1));
  const auto save_over_link = [&](const fs::path& target, const std::string& text) {
    fs::remove(path);
    fs::create_symlink(target, path);
    if (!text.empty()) std::ofstream(target, std::ios::binary) << text;
    PresetFile file(path, PresetFile::write_access_for(scene, "", true));
    (void)file.load();
    return saved(file, list_of(2));
  };
  const fs::path outside = folder / "precious";
  for (const std::string& text : {presets, std::string("export PATH")}) {
    EXPECT_EQ(save_over_link(outside, text), "error: the presets could not be saved: it is a link to " +
                                                 outside.string() +
                                                 ", outside of the show's folder; put a file in its place");
    EXPECT_EQ(content(outside), text);
    EXPECT_TRUE(fs::is_symlink(path));
  }
  const fs::path inside = show / "shared.json";
  EXPECT_EQ(save_over_link(inside, presets), "");
  EXPECT_EQ(PresetFile(inside.string()).load()->presets.at(0)->values, (std::vector<double>{2}));
  EXPECT_EQ(save_over_link(inside, "-- a script"), "error: the presets could not be saved: it is a link to " +
                                                       inside.string() +
                                                       ", which is not a preset file; put a file in its place");
  EXPECT_EQ(content(inside), "-- a script");
  // a dangling link is replaced itself
  EXPECT_EQ(save_over_link(folder / "nothing", ""), "");
  EXPECT_FALSE(fs::exists(folder / "nothing"));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path)));
}

TEST_F(PresetFileTest, ReplacesOnlyRegularFiles) {
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  PresetFile file(path);
  EXPECT_FALSE(file.load().ok());
  EXPECT_EQ(saved(file, list_of(1)), "error: the presets could not be saved: it is not a regular file");
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST_F(PresetFileTest, TheFirstProgramOwnsTheFile) {
  const std::string scene = (folder / "scene.lua").string();
  const std::string locks = (folder / "state/locks").string();
  const auto open = [&](bool stays) {
    auto file = std::make_unique<PresetFile>(path, PresetFile::write_access_for(scene, locks, stays));
    (void)file->load();
    return file;
  };
  const std::string rejection = "error: the presets could not be saved: another program plays this scene and owns them";
  auto fast = open(false);
  auto first = open(true);
  auto second = open(true);
  EXPECT_EQ(saved(*second, list_of(2)), rejection);
  EXPECT_EQ(saved(*fast, list_of(3)), rejection);
  EXPECT_EQ(saved(*first, list_of(1)), "");
  EXPECT_EQ(saved(*first, list_of(4)), "");
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json", "state"})) << "nothing was backed up";
  first = nullptr;
  // a program without a permanent lock owns them only during a save
  EXPECT_NE(saved(*fast, list_of(5)).find("was backed up as scene.presets.json.old"), std::string::npos);
  EXPECT_NE(saved(*second, list_of(6)).find("was backed up as scene.presets.json.old-2"), std::string::npos);
  EXPECT_EQ(saved(*fast, list_of(7)), rejection);
  EXPECT_EQ(PresetFile(path).load()->presets.at(0)->values, (std::vector<double>{6}));
  second = nullptr;
  EXPECT_TRUE(fs::is_empty(locks));
}

// killed during saves, at a time that depends on the scheduling of the kernel
TEST_F(PresetFileTest, IsCompleteAfterAKillAtAnyTime) {
  Random random(9, "kill");
  int newest = 0;
  for (int round = 0; round < 200; round++) {
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      PresetFile file(path);
      (void)file.load();
      std::string notice;
      for (int i = newest + 1; file.save(list_of(i, 100), notice); i++) {
        const char done = 1;
        if (::write(pipe_ends[1], &done, 1) != 1) break;
      }
      _exit(0);
    }
    close(pipe_ends[1]);
    const int saves = static_cast<int>(random.uniform(0, 4));
    char done = 0;
    for (int i = 0; i < saves; i++) ASSERT_EQ(::read(pipe_ends[0], &done, 1), 1);
    for (volatile int spin = static_cast<int>(random.uniform(0, 300000)); spin > 0;) spin = spin - 1;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(pipe_ends[0]);
    const Result<ParsedPresets> read = PresetFile(path).load();
    ASSERT_TRUE(read.ok()) << read.error();
    ASSERT_TRUE(read->problems.empty());
    if (newest + saves == 0) continue;
    const std::vector<double>& values = read->presets.at(0)->values;
    ASSERT_EQ(values, std::vector<double>(100, values.at(0))) << "all values are of the same save";
    ASSERT_GE(values[0], newest + saves) << "completed saves are not lost";
    newest = static_cast<int>(values[0]);
  }
  EXPECT_GT(newest, 100);
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.presets.json"}))
      << "temporary files of killed programs are removed";
}

}  // namespace
}  // namespace limber::engine
