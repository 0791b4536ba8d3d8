// ./run on machines that lack something: each error has its text and fix, and no unnecessary program is called. The
// machine consists of small scripts in a folder that is the whole PATH, so the test changes nothing and needs no
// network.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber {
namespace {

namespace fs = std::filesystem;

struct RunResult {
  int code = -1;
  std::string text;
  std::string calls;  ///< Arguments of apt-get, sudo and cmake, one call per line.
};

/// A checkout with only `run`, on a machine with everything installed; tests remove or break parts of it.
class Machine {
 public:
  Machine() {
    std::string pattern = (fs::temp_directory_path() / "limber_run_XXXXXX").string();
    root_ = ::mkdtemp(pattern.data());
    fs::create_directories(root_ / "bin");
    fs::create_directories(root_ / "tree/.ci/package");
    for (const char* file : {"run", ".ci/lib.sh", ".ci/uninstall.sh", ".ci/packages", ".ci/package/package.sh"}) {
      fs::copy_file(fs::path(LIMBER_SOURCE_DIR) / file, root_ / "tree" / file);
    }
    for (const char* real : {"bash", "env", "dirname", "cut", "grep", "awk", "sed", "tee", "mktemp", "rm", "mkdir",
                             "cat", "head", "tail", "uname", "sh", "chmod"}) {
      fs::create_symlink(
          fs::exists(fs::path("/usr/bin") / real) ? fs::path("/usr/bin") / real : fs::path("/bin") / real,
          root_ / "bin" / real);
    }
    write("os-release", "ID=debian\nVERSION_ID=12\nPRETTY_NAME='Debian GNU/Linux 12'\n");
    program("id", "echo 0");
    program("nproc", "echo 2");
    program("g++", "echo 12");
    // reports every package as installed
    program("dpkg-query", "shift 2; for p in \"$@\"; do echo \"ii $p \"; done");
    program("apt-get", "echo apt-get \"$@\" >>\"$CALLS\"");
    program("cmake",
            "echo cmake \"$@\" >>\"$CALLS\"\n"
            "case $1 in\n"
            "  --preset) echo \"CMAKE_HOME_DIRECTORY:INTERNAL=$PWD\" >build/CMakeCache.txt; : >build/build.ninja ;;\n"
            "  --build) printf '#!/bin/sh\\necho \"limber $*\"\\n' >build/limber; chmod +x build/limber ;;\n"
            "esac");
  }
  ~Machine() { fs::remove_all(root_); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  void write(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }
  void program(const std::string& name, const std::string& body) const {
    fs::remove(root_ / "bin" / name);
    write("bin/" + name, "#!/bin/sh\n" + body + "\n");
    fs::permissions(root_ / "bin" / name, fs::perms::owner_all);
  }
  void without(const std::string& name) const { fs::remove(root_ / "bin" / name); }
  fs::path path(const std::string& name) const { return root_ / name; }
  bool has(const std::string& name) const { return fs::exists(path(name)); }
  void nothing_installed() const { program("dpkg-query", "exit 1"); }

  RunResult run(const std::string& arguments = "") const {
    const std::string root = root_.string();
    fs::remove(root_ / "calls");
    const std::string command = "cd " + root + "/tree && /usr/bin/env -i PATH=" + root + "/bin TMPDIR=" + root +
                                " HOME=" + root + "/home CALLS=" + root + "/calls LIMBER_OS_RELEASE=" + root +
                                "/os-release ./run " + arguments + " </dev/null >" + root + "/out 2>&1";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out"), read("calls")};
  }

 private:
  std::string read(const std::string& name) const {
    std::ifstream in(root_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path root_;
};

TEST(Run, BuildsPlaysAndReportsThePath) {
  const Machine machine;
  const RunResult first = machine.run("scripts/hello.lua --fast");
  EXPECT_EQ(first.code, 0) << first.text;
  EXPECT_TRUE(first.text.starts_with("run: Limber on Debian GNU/Linux 12\n")) << first.text;
  EXPECT_TRUE(first.text.ends_with("limber play scripts/hello.lua --fast\n")) << first.text;
  EXPECT_EQ(
      first.calls,
      "cmake --preset release -DLIMBER_WERROR=OFF -DLIMBER_TESTS=OFF\ncmake --build build --target limber -j 2\n");
}

TEST(Run, SecondRunNeitherConfiguresNorCallsApt) {
  const Machine machine;
  ASSERT_EQ(machine.run().code, 0);
  EXPECT_EQ(machine.run().calls, "cmake --build build --target limber -j 2\n");
}

TEST(Run, BuildOnlyDoesNotPlay) {
  const Machine machine;
  const RunResult result = machine.run("--build-only");
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.text.ends_with("run: built: build/limber\n")) << result.text;
}

TEST(Run, InstallsMissingPackagesAsRoot) {
  const Machine machine;
  // all but two packages are installed
  machine.program("dpkg-query",
                  "shift 2; for p in \"$@\"; do case $p in cmake|libfmt-dev) ;; *) echo \"ii $p \" ;; esac; done");
  const RunResult result = machine.run();
  EXPECT_EQ(result.code, 0) << result.text;
  EXPECT_NE(result.text.find("run: installing with apt: cmake libfmt-dev\n"), std::string::npos) << result.text;
  EXPECT_NE(result.calls.find("apt-get update"), std::string::npos);
  EXPECT_NE(result.calls.find(" cmake libfmt-dev\n"), std::string::npos) << result.calls;
}

TEST(Run, UninstallRemovesFilesAndPackages) {
  const Machine machine;
  EXPECT_EQ(machine.run("--uninstall").text, "run: nothing to remove\n");
  machine.program("dpkg-query",
                  "shift 2; for p in \"$@\"; do case $p in cmake|libfmt-dev) ;; *) echo \"ii $p \" ;; esac; done");
  ASSERT_EQ(machine.run("--build-only").code, 0);
  ASSERT_EQ(machine.run("--build-only").code, 0);
  fs::create_directories(machine.path("home/.config/limber"));
  fs::create_directories(machine.path("home/.config/others"));
  machine.program("apt-get", "exit 100");
  EXPECT_EQ(machine.run("--uninstall").code, 3);
  EXPECT_TRUE(machine.has("tree/build")) << "a failed removal can be repeated";
  machine.program("apt-get", "echo apt-get \"$@\" >>\"$CALLS\"");
  const RunResult result = machine.run("--uninstall");
  EXPECT_EQ(result.code, 0) << result.text;
  EXPECT_EQ(result.calls, "apt-get remove -y cmake libfmt-dev\n");
  EXPECT_FALSE(machine.has("tree/build"));
  EXPECT_FALSE(machine.has("home/.config/limber"));
  EXPECT_TRUE(machine.has("home/.config/others"));
  EXPECT_TRUE(machine.has("tree/run"));
}

TEST(Run, PackageRequiresDpkgShlibdeps) {
  const Machine machine;
  machine.program("dpkg-deb", "echo dpkg-deb \"$@\" >>\"$CALLS\"");
  const RunResult result = machine.run("--package");
  EXPECT_EQ(result.code, 3) << result.text;
  EXPECT_NE(result.text.find("dpkg-shlibdeps not found, so no package can be built."), std::string::npos)
      << result.text;
  EXPECT_NE(result.text.find("fix: apt-get install dpkg-dev\n"), std::string::npos) << result.text;
  EXPECT_EQ(result.calls.find("dpkg-deb"), std::string::npos) << result.calls;
  EXPECT_EQ(result.text.find("limber play"), std::string::npos) << "it must not play";
}

TEST(Run, PackageInstallsItsToolsAsRoot) {
  const Machine machine;
  machine.program("dpkg-query",
                  "shift 2; for p in \"$@\"; do case $p in dpkg-dev) ;; *) echo \"ii $p \" ;; esac; done");
  EXPECT_NE(machine.run("--package").calls.find(" dpkg-dev\n"), std::string::npos);
  EXPECT_EQ(machine.run("--build-only").calls.find("dpkg-dev"), std::string::npos) << "a build needs no package";
}

TEST(Run, TarballIsBuiltOnlyOnTheOldestRelease) {
  const Machine machine;
  machine.write("os-release", "ID=debian\nVERSION_ID=13\nPRETTY_NAME='Debian GNU/Linux 13'\n");
  const RunResult result = machine.run("--tarball");
  EXPECT_EQ(result.code, 3) << result.text;
  EXPECT_NE(result.text.find("would not run on Debian 12"), std::string::npos) << result.text;
  EXPECT_NE(result.text.find("fix: build it on Debian 12"), std::string::npos) << result.text;
}

TEST(Run, TriesOnOtherSystemsWithAWarning) {
  const Machine machine;
  machine.write("os-release", "ID=ubuntu\nVERSION_ID=24.04\nPRETTY_NAME='Ubuntu 24.04'\n");
  const RunResult result = machine.run();
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.text.starts_with("run: Limber on Ubuntu 24.04: untested (Debian 12 and 13 are tested), trying\n"))
      << result.text;
}

TEST(Run, AcceptsDebian13) {
  const Machine machine;
  machine.write("os-release", "ID=debian\nVERSION_ID=13\nPRETTY_NAME='Debian GNU/Linux 13 (trixie)'\n");
  const RunResult result = machine.run();
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.text.starts_with("run: Limber on Debian GNU/Linux 13 (trixie)\n")) << result.text;
}

TEST(Run, NeverLetsAptRemovePackages) {
  const Machine machine;
  machine.nothing_installed();
  machine.program(
      "apt-get",
      "echo apt-get \"$@\" >>\"$CALLS\"\n"
      "case $1 in -s) echo 'Inst cmake (3.25)'; echo 'Remv browser [1.0]'; echo 'Remv editor [2.0]' ;; esac");
  const RunResult result = machine.run();
  EXPECT_EQ(result.code, 3) << result.text;
  EXPECT_NE(result.text.find("run: apt would remove packages in order to install g++ cmake "), std::string::npos)
      << result.text;
  EXPECT_NE(result.text.find(": browser editor. Nothing was changed."), std::string::npos) << result.text;
  EXPECT_EQ(result.calls.find("apt-get install"), std::string::npos) << result.calls;
  // if the package lists change between the simulation and the installation, apt itself has to stop
  machine.program("apt-get", "echo apt-get \"$@\" >>\"$CALLS\"");
  EXPECT_NE(machine.run().calls.find("apt-get install -y --no-install-recommends --no-remove "), std::string::npos);
}

TEST(Run, ReconfiguresAMovedCheckout) {
  const Machine machine;
  ASSERT_EQ(machine.run().code, 0);
  machine.write("tree/build/CMakeCache.txt", "CMAKE_HOME_DIRECTORY:INTERNAL=/somewhere/else\n");
  const RunResult result = machine.run();
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.text.find("the checkout has moved"), std::string::npos) << result.text;
  EXPECT_NE(result.calls.find("--preset release"), std::string::npos) << result.calls;
}

/// A broken machine: its defect, and the error of ./run. All errors exit with 3.
struct ErrorCase {
  const char* name;
  void (*break_machine)(const Machine&);
  const char* text;
  const char* fix;
};

/// Prints the parameter of a failed test.
std::ostream& operator<<(std::ostream& out, const ErrorCase& error_case) { return out << error_case.name; }

class RunErrors : public testing::TestWithParam<ErrorCase> {};

TEST_P(RunErrors, HaveACauseAndAFix) {
  const Machine machine;
  GetParam().break_machine(machine);
  const RunResult result = machine.run();
  EXPECT_EQ(result.code, 3) << result.text;
  EXPECT_NE(result.text.find(std::string("run: ") + GetParam().text), std::string::npos) << result.text;
  EXPECT_NE(result.text.find(std::string("fix: ") + GetParam().fix), std::string::npos) << result.text;
  EXPECT_EQ(result.text.find("limber play"), std::string::npos) << "it must not play";
}

const ErrorCase kErrorCases[] = {
    {"no_sudo",
     [](const Machine& m) {
       m.nothing_installed();
       m.program("id", "echo 1000");
     },
     "packages are missing, this is not root, and there is no sudo.",
     "as root: apt-get update && apt-get install g++ cmake "},
    {"no_terminal",
     [](const Machine& m) {
       m.nothing_installed();
       m.program("id", "echo 1000");
       m.program("sudo", "exec \"$@\"");
     },
     "packages are missing, this is not root, and there is no terminal to ask on.",
     "sudo apt-get update && sudo apt-get"},
    {"no_network",
     [](const Machine& m) {
       m.nothing_installed();
       m.program("apt-get",
                 "echo \"Err:1 http://deb.debian.org bookworm InRelease\"\n"
                 "echo \"E: Temporary failure resolving 'deb.debian.org'\"; exit 100");
     },
     "apt cannot reach its servers, so nothing was installed", "connect to the network once"},
    {"apt_fails",
     [](const Machine& m) {
       m.nothing_installed();
       m.program("apt-get", "echo 'E: Unable to locate package libbullet-dev'; exit 100");
     },
     "apt could not install the packages", "fix the problem that apt reports above"},
    {"no_apt",
     [](const Machine& m) {
       m.without("dpkg-query");
       m.without("apt-get");
       m.without("g++");
     },
     "this system has no apt, so packages can't be installed automatically; not found: g++ ",
     "install them under the names"},
    {"no_compiler", [](const Machine& m) { m.without("g++"); }, "there is no C++ compiler", "apt-get install g++"},
    {"old_compiler", [](const Machine& m) { m.program("g++", "echo 10.2.1"); }, "g++ is version 10, Limber needs 12",
     "install a newer g++"},
    {"no_room", [](const Machine& m) { m.write("tree/build", "a file in its way"); }, "cannot write to ",
     "work in a clone"},
    {"configure_fails", [](const Machine& m) { m.program("cmake", "echo 'CMake Error: no glm'; exit 1"); },
     "configuring the build failed", "fix the problem above"},
    {"build_fails",
     [](const Machine& m) { m.program("cmake", "case $1 in --build) exit 1 ;; esac; : >build/build.ninja"); },
     "the build failed", "on a full disk"},
    {"build_fails_elsewhere",
     [](const Machine& m) {
       m.write("os-release", "ID=ubuntu\nVERSION_ID=24.04\nPRETTY_NAME='Ubuntu 24.04'\n");
       m.program("cmake", "case $1 in --build) exit 1 ;; esac; : >build/build.ninja");
     },
     "the build failed on Ubuntu 24.04, an untested system", "report that error"},
};
INSTANTIATE_TEST_SUITE_P(Run, RunErrors, testing::ValuesIn(kErrorCases),
                         [](const testing::TestParamInfo<ErrorCase>& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace limber
