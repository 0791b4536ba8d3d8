// The commit that a build reports: for a checkout, an archive without git, and an archive inside another checkout.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace limber {
namespace {

namespace fs = std::filesystem;

class BuildInfo : public testing::Test {
 protected:
  BuildInfo() {
    std::string pattern = (fs::temp_directory_path() / "limber_info_XXXXXX").string();
    root_ = ::mkdtemp(pattern.data());
    fs::create_directories(root_ / "tree");
    for (const char* file : {".gitattributes", ".git_archival.txt"})
      fs::copy_file(fs::path(LIMBER_SOURCE_DIR) / file, root_ / "tree" / file);
  }
  ~BuildInfo() override { fs::remove_all(root_); }

  void shell(const std::string& command) const {
    const std::string all = "cd '" + root_.string() + "' && export GIT_CEILING_DIRECTORIES='" +
                            root_.parent_path().string() + "' HOME='" + root_.string() + "' && " + command;
    ASSERT_EQ(std::system(all.c_str()), 0) << command;
  }
  std::string content(const std::string& name) const {
    std::ifstream in(root_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// Returns the commit reported by a build of this folder; checks the version.
  std::string commit_of(const std::string& folder) const {
    shell("cmake -DSOURCE='" + (root_ / folder).string() + "' -DVERSION=4.5.6 -DDATA_DIR=/data -DTO=out.cpp -P '" +
          LIMBER_SOURCE_DIR "/src/base/build_info.cmake'");
    const std::string text = content("out.cpp");
    EXPECT_NE(text.find("version() { return \"4.5.6\"; }"), std::string::npos) << text;
    const std::string prefix = "commit() { return \"";
    const std::size_t at = text.find(prefix);
    if (at == std::string::npos) return "none";
    return text.substr(at + prefix.size(), text.find('"', at + prefix.size()) - at - prefix.size());
  }
  /// Makes the tree a checkout with one commit and returns its hash.
  std::string check_in() const {
    shell(
        "git init -q tree && cd tree && git add -A && git -c user.name=a -c user.email=a@b.example "
        "-c commit.gpgsign=false commit -qm all && git rev-parse HEAD >../hash");
    return content("hash").substr(0, 10);
  }

  fs::path path(const std::string& name) const { return root_ / name; }

 private:
  fs::path root_;
};

TEST_F(BuildInfo, ACheckoutReportsItsCommit) {
  const std::string hash = check_in();
  EXPECT_EQ(commit_of("tree"), hash);
  std::ofstream(path("tree/.gitattributes")) << "changed\n";
  EXPECT_EQ(commit_of("tree"), hash + "+");
}

TEST_F(BuildInfo, AnArchiveReportsItsCommit) {
  const std::string hash = check_in();
  shell("mkdir unpacked && git -C tree archive HEAD | tar -xf - -C unpacked");
  EXPECT_EQ(commit_of("unpacked"), hash);
}

TEST_F(BuildInfo, AnArchiveInsideACheckoutReportsItsOwnCommit) {
  const std::string hash = check_in();
  shell(
      "git init -q home && cd home && git -c user.name=a -c user.email=a@b.example -c commit.gpgsign=false commit -qm "
      "other --allow-empty && mkdir unpacked && git -C ../tree archive HEAD | tar -xf - -C unpacked");
  EXPECT_EQ(commit_of("home/unpacked"), hash);
}

TEST_F(BuildInfo, ReportsUnknownWithoutGitAndArchive) {
  EXPECT_EQ(commit_of("tree"), "unknown") << "the archive's file still has its placeholder";
  fs::remove(path("tree/.git_archival.txt"));
  EXPECT_EQ(commit_of("tree"), "unknown");
}

}  // namespace
}  // namespace limber
