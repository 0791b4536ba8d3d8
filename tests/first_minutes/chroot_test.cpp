// .ci/chroot with fakes for debootstrap, unshare, mount and chroot, so that the test needs neither root nor a network.
#include <sys/wait.h>
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

/// A checkout with .ci/chroot, and fakes that only pretend to create and enter roots.
class Roots {
 public:
  Roots() {
    std::string pattern = (fs::temp_directory_path() / "limber_chroot_XXXXXX").string();
    root_ = fs::canonical(::mkdtemp(pattern.data()));
    fs::create_directories(root_ / "bin");
    fs::create_directories(root_ / "tree/.ci");
    for (const char* file : {".ci/chroot", ".ci/lib.sh"})
      fs::copy_file(fs::path(LIMBER_SOURCE_DIR) / file, root_ / "tree" / file);
    write("mounts", "22 1 0:21 / /proc rw - proc proc rw\n");
    program("id", "echo 0");
    program("apt-get", "echo 'Debian|http://mirror.example/debian/'; echo 'Debian-Security|http://mirror.example/s/'");
    program("apt-config", "echo 'Acquire::http::Proxy \"http://proxy.example:3142\";'");
    // creates a minimal system; its last arguments are RELEASE, FOLDER and MIRROR
    program("debootstrap",
            "echo \"debootstrap $*\" \"$http_proxy\" >>\"$CALLS\"\n"
            "while [ $# -gt 3 ]; do shift; done\n"
            "for d in etc/apt/apt.conf.d usr/sbin proc dev tmp run var/cache/apt/archives var/lib/apt/lists; do\n"
            "  mkdir -p \"$2/$d\"\ndone\n: >\"$2/var/lib/apt/lists/lock\"; echo \"$1\" >\"$2/etc/release\"");
    program("unshare", "while [ \"$1\" != -- ]; do shift; done; shift; exec \"$@\"");
    program("mount", "exit 0");
    // enters a root by changing the directory
    program("chroot", "root=$1; while [ \"$1\" != sh ]; do shift; done; cd \"$root\" && shift 5 && exec \"$@\"");
  }
  ~Roots() { fs::remove_all(root_); }
  Roots(const Roots&) = delete;
  Roots& operator=(const Roots&) = delete;

  void write(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }
  void program(const std::string& name, const std::string& body) const {
    write("bin/" + name, "#!/bin/sh\n" + body + "\n");
    fs::permissions(root_ / "bin" / name, fs::perms::owner_all);
  }
  fs::path path(const std::string& name) const { return root_ / name; }
  fs::path chroots() const { return root_ / "roots"; }

  int run(const std::string& arguments) {
    fs::remove(root_ / "calls");
    const std::string root = root_.string();
    const std::string command = "cd " + root + "/tree && env -u CCACHE_DIR -u http_proxy PATH=" + root +
                                "/bin:$PATH CALLS=" + root + "/calls LIMBER_CHROOTS=" + root +
                                "/roots LIMBER_MOUNTINFO=" + root + "/mounts bash .ci/chroot " + arguments + " >" +
                                root + "/out 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    text = read("out");
    calls = read("calls");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(root_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::string text;   ///< Output.
  std::string calls;  ///< Arguments of debootstrap.

 private:
  fs::path root_;
};

TEST(Chroot, CreatesARootOnceFromTheHostsMirrorAndRunsTheCommand) {
  Roots roots;
  EXPECT_EQ(roots.run("trixie --no-source -- sh -c 'cat etc/release; echo here >left; exit 7'"), 7) << roots.text;
  EXPECT_NE(roots.text.find("chroot: creating a minimal trixie "), std::string::npos) << roots.text;
  EXPECT_TRUE(roots.text.ends_with("\ntrixie\n")) << roots.text;
  EXPECT_NE(roots.calls.find(" http://mirror.example/debian http://proxy.example:3142\n"), std::string::npos)
      << roots.calls;
  EXPECT_EQ(roots.read("roots/trixie/etc/apt/sources.list"),
            "deb http://mirror.example/debian trixie main\ndeb http://mirror.example/debian trixie-updates main\n"
            "deb http://mirror.example/s trixie-security main\n");
  EXPECT_EQ(roots.run("trixie --no-source cat left"), 0);
  EXPECT_EQ(roots.text, "here\n") << "the existing root is reused";
  EXPECT_EQ(roots.calls, "");
}

TEST(Chroot, ReusesARootForFreshCopiesAndOtherNames) {
  Roots roots;
  ASSERT_EQ(roots.run("sid --no-source -- sh -c 'echo here >left'"), 0) << roots.text;
  EXPECT_EQ(roots.run("sid --no-source --name other ls left"), 2) << roots.text;
  EXPECT_EQ(roots.run("sid --no-source cat left"), 0) << roots.text;
  EXPECT_EQ(roots.run("sid --no-source --fresh ls left"), 2) << roots.text;
  EXPECT_EQ(roots.calls, "");
  EXPECT_EQ(roots.read("roots/sid/etc/apt/sources.list"), "deb http://mirror.example/debian sid main\n");
}

TEST(Chroot, AnInterruptedRootIsCreatedAgain) {
  Roots roots;
  const std::string whole = roots.read("bin/debootstrap");
  roots.program("debootstrap", "while [ $# -gt 3 ]; do shift; done; mkdir -p \"$2/half\"; echo 'E: no answer'; exit 1");
  EXPECT_EQ(roots.run("trixie --no-source true"), 3);
  EXPECT_NE(roots.text.find("E: no answer"), std::string::npos) << roots.text;
  EXPECT_NE(roots.text.find("chroot: debootstrap could not create trixie"), std::string::npos) << roots.text;
  roots.program("debootstrap", whole);
  EXPECT_EQ(roots.run("trixie --no-source -- sh -c '[ ! -e half ]'"), 0) << roots.text;
}

TEST(Chroot, RemovesARootOnlyWithoutMounts) {
  Roots roots;
  ASSERT_EQ(roots.run("trixie --no-source true"), 0) << roots.text;
  const fs::path root = roots.chroots() / "trixie";
  for (const std::string& at : {root.string(), (root / "proc").string()}) {
    roots.write("mounts", "22 1 0:21 / " + at + " rw - proc proc rw\n");
    EXPECT_EQ(roots.run("trixie --remove"), 3) << at;
    EXPECT_NE(roots.text.find("something is mounted in " + root.string()), std::string::npos) << roots.text;
    EXPECT_EQ(roots.run("trixie --no-source --fresh true"), 3) << at;
    EXPECT_TRUE(fs::exists(root / "etc/release"));
  }
  // another folder with the same prefix in its name
  roots.write("mounts", "22 1 0:21 / " + root.string() + "2/proc rw - proc proc rw\n");
  EXPECT_EQ(roots.run("trixie --remove"), 0) << roots.text;
  EXPECT_FALSE(fs::exists(root));
}

TEST(Chroot, RejectsInvalidArguments) {
  Roots roots;
  EXPECT_EQ(roots.run("../elsewhere true"), 2);
  EXPECT_EQ(roots.run("trixie"), 2);
  EXPECT_NE(roots.text.find("no command is given"), std::string::npos) << roots.text;
  EXPECT_EQ(roots.run("trixie --sideways true"), 2);
  EXPECT_EQ(roots.run("trixie --no-source --arch 'arm 64' true"), 2);
  EXPECT_EQ(roots.run("trixie true"), 3);
  EXPECT_NE(roots.text.find("is not a git checkout"), std::string::npos) << roots.text;
  roots.program("id", "echo 1000");
  EXPECT_EQ(roots.run("trixie --no-source true"), 3);
  EXPECT_NE(roots.text.find("only root can"), std::string::npos) << roots.text;
}

}  // namespace
}  // namespace limber
