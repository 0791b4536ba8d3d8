// ./check --long on a machine with everything installed: selection of parts by name, and skipping of passed ones.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber {
namespace {

namespace fs = std::filesystem;

/// A repository with `check`, its steps, and three test parts that need no build.
class CheckTree {
 public:
  CheckTree() {
    std::string pattern = (fs::temp_directory_path() / "limber_check_XXXXXX").string();
    root_ = ::mkdtemp(pattern.data());
    fs::create_directories(root_ / "bin");
    fs::copy_file(fs::path(LIMBER_SOURCE_DIR) / "check", root_ / "check");
    fs::copy(fs::path(LIMBER_SOURCE_DIR) / ".ci", root_ / ".ci");
    write(".gitignore", "/build/\n/bin/\n");
    write(".ci/test_steps.sh",
          "# --long apple: passes\nlong_apple() { echo apple >>build/calls; pass; }\n"
          "# --long pear: fails\nlong_pear() { echo pear >>build/calls; fail pear; }\n"
          "# --long plum: passes\nlong_plum() { echo plum >>build/calls; pass; }\n");
    // every package is installed
    program("dpkg-query", "shift 2; for p in \"$@\"; do echo \"ii $p \"; done");
    program("g++", "echo 12");
    write("bin/os-release", "ID=debian\nVERSION_ID=12\nPRETTY_NAME='Debian GNU/Linux 12'\n");
    commit();
  }
  ~CheckTree() { fs::remove_all(root_); }
  CheckTree(const CheckTree&) = delete;
  CheckTree& operator=(const CheckTree&) = delete;

  void write(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }
  void commit() const {
    shell(
        "git init -q . && git add -A && git -c user.name=a -c user.email=a@b.example -c commit.gpgsign=false commit "
        "-qm all --allow-empty");
  }

  void program(const std::string& name, const std::string& body) const {
    write("bin/" + name, "#!/bin/sh\n" + body + "\n");
    fs::permissions(root_ / "bin" / name, fs::perms::owner_all);
  }

  int check(const std::string& arguments) {
    fs::remove(root_ / "build/calls");
    const int code = shell("PATH=\"$PWD/bin:$PATH\" LIMBER_OS_RELEASE=bin/os-release ./check " + arguments);
    text = read("bin/out");
    calls = read("build/calls");
    return code;
  }

  std::string text;   ///< Output.
  std::string calls;  ///< The parts that it ran.

 private:
  int shell(const std::string& command) const {
    const int status =
        std::system(("cd '" + root_.string() + "' && { " + command + "; } >bin/out 2>&1 </dev/null").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(root_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path root_;
};

TEST(Check, RunsTheNamedLongParts) {
  CheckTree tree;
  EXPECT_EQ(tree.check("--long plum apple"), 0) << tree.text;
  EXPECT_EQ(tree.calls, "plum\napple\n") << tree.text;
  EXPECT_NE(tree.text.find("check: plum: passed in "), std::string::npos) << tree.text;
  EXPECT_TRUE(tree.text.ends_with("2 passed, 0 failed\n")) << tree.text;
}

TEST(Check, SkipsLongPartsThatPassedAtTheSameCommit) {
  CheckTree tree;
  EXPECT_EQ(tree.check("--long apple pear"), 1) << tree.text;
  EXPECT_EQ(tree.calls, "apple\npear\n") << tree.text;
  EXPECT_EQ(tree.check("--long apple pear plum"), 1) << tree.text;
  EXPECT_EQ(tree.calls, "pear\nplum\n") << "the first one passed before: " << tree.text;
  EXPECT_TRUE(tree.text.ends_with("2 passed, 1 failed\n")) << tree.text;
  tree.commit();
  EXPECT_EQ(tree.check("--long apple"), 0) << tree.text;
  EXPECT_EQ(tree.calls, "apple\n") << "another commit: " << tree.text;
  tree.write("new_file", "");
  EXPECT_EQ(tree.check("--long apple"), 0) << tree.text;
  EXPECT_EQ(tree.calls, "apple\n") << "the files are not those of the commit: " << tree.text;
}

TEST(Check, RejectsUnknownLongParts) {
  CheckTree tree;
  EXPECT_EQ(tree.check("--long apple cherry"), 2);
  EXPECT_EQ(tree.calls, "");
  EXPECT_NE(tree.text.find("check: --long has no part 'cherry'."), std::string::npos) << tree.text;
  EXPECT_NE(tree.text.find("fix: ./check --help lists them."), std::string::npos) << tree.text;
}

/// Packages that ./check requests from apt on a machine of this release that has none.
std::string packages_of(CheckTree& tree, const std::string& arguments, const std::string& os_release) {
  tree.write("bin/os-release", os_release);
  tree.program("dpkg-query", "exit 1");
  tree.program("id", "echo 0");
  tree.program(
      "apt-get",
      "[ $1 = -s ] || exit 0\nmkdir -p build\necho \"$* \" | tr '\\n' ' ' >>build/calls\necho Remv everything");
  EXPECT_EQ(tree.check(arguments), 3) << tree.text;
  return tree.calls;
}

TEST(Check, InstallsThePackagesOfItsStepsAndRelease) {
  CheckTree tree;
  const std::string debian_12 = "ID=debian\nVERSION_ID=12\n";
  const std::string debian_13 = "ID=debian\nVERSION_ID=13\n";
  const auto has = [](const std::string& list, const std::string& package) {
    return list.find(" " + package + " ") != std::string::npos;
  };
  struct Case {
    const char* arguments;
    std::string system;
    std::vector<std::string> with, without;
  };
  const Case cases[] = {
      {"--only asan", debian_12, {"g++", "libgtest-dev", "clang-14"}, {"clang", "valgrind", "clang-format-14"}},
      {"--only asan", debian_13, {"g++", "libgtest-dev", "clang", "libclang-rt-dev"}, {"clang-14", "valgrind"}},
      {"--only asan", "ID=ubuntu\nVERSION_ID=13\n", {"g++", "clang"}, {"clang-14"}},
      {"--only style", debian_12, {"clang-format-14", "clang-tidy-14"}, {"clang-14", "valgrind"}},
      {"--only style", debian_13, {"git"}, {"clang-format-14", "clang-tidy-14"}},
      {"--only valgrind", debian_13, {"valgrind"}, {"clang", "debootstrap"}},
      {"--long apple", debian_12, {"debootstrap", "valgrind", "clang-14"}, {"clang"}},
  };
  for (const Case& c : cases) {
    const std::string packages = packages_of(tree, c.arguments, c.system);
    for (const std::string& p : c.with) EXPECT_TRUE(has(packages, p)) << p << c.arguments << c.system << packages;
    for (const std::string& p : c.without) EXPECT_FALSE(has(packages, p)) << p << c.arguments << c.system << packages;
  }
}

TEST(Check, HelpListsTheLongParts) {
  CheckTree tree;
  EXPECT_EQ(tree.check("--help"), 0);
  for (const char* line : {"\n  apple            passes\n", "\n  valgrind         ", "\n  twenty           "})
    EXPECT_NE(tree.text.find(line), std::string::npos) << line << tree.text;
}

}  // namespace
}  // namespace limber
