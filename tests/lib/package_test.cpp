// The installed library: the examples are built with its files for CMake and pkg-config, and reach the hash of the
// program. The Python package in the build folder.
#include <gtest/gtest.h>

#include <filesystem>

#include <fmt/format.h>

#include "app/program.h"
#include "base/sanitized.h"
#include "support/skip.h"

namespace limber::lib::test {
namespace {

using app::test::Process;
using app::test::RunResult;
using app::test::TempFolder;

constexpr const char* kReason = "the examples are built without sanitizers, and the other tests cover the library";

std::string succeed(const std::vector<std::string>& words) {
  const RunResult result = Process(words).finish();
  EXPECT_EQ(result.code, 0) << fmt::format("{}\n{}{}", words[0], result.out, result.err);
  return result.out;
}

void install(const std::string& prefix) {
  succeed({"cmake", "--install", LIMBER_BUILD, "--component", "lib", "--prefix", prefix});
}

std::string find_file(const std::string& folder, std::string_view name) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().filename() == name) return entry.path().string();
  return {};
}

// ./run builds the program alone, so installing it must not need the library.
TEST(LimberPackage, TheProgramIsInstalledWithoutTheLibrary) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer || is_emulated(), kReason);
  const TempFolder folder;
  succeed({"cmake", "--install", LIMBER_BUILD, "--prefix", folder.path()});
  EXPECT_NE(find_file(folder.path(), "limber"), "");
  EXPECT_EQ(find_file(folder.path(), "liblimber.so"), "");
  EXPECT_EQ(find_file(folder.path(), "limber.h"), "");
}

TEST(LimberPackage, ExamplesReachTheHashOfTheProgram) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer || is_emulated(), kReason);
  const TempFolder folder;
  const std::string prefix = folder.path() + "/prefix";
  const std::string build = folder.path() + "/build";
  install(prefix);
  succeed({"cmake", "-S", prefix + "/share/doc/limber/examples/library", "-B", build, "-DCMAKE_PREFIX_PATH=" + prefix});
  succeed({"cmake", "--build", build});
  for (const char* scene : {"scripts/quadruped.lua", "scripts/tentacle.lua", "scripts/hello.lua"}) {
    for (const char* threads : {"1", "3"}) {
      const std::string expected =
          succeed({LIMBER_PROGRAM, scene, "--fast", "--hash", "--duration", "3", "--seed", "5"});
      const std::string reached =
          succeed({build + "/player", scene, "--duration", "3", "--seed", "5", "--threads", threads});
      EXPECT_EQ(reached, expected) << scene;
      EXPECT_NE(expected.find("hash "), std::string::npos);
    }
  }
  EXPECT_NE(succeed({build + "/sway"}).find("0.25 s: "), std::string::npos);
  EXPECT_NE(succeed({build + "/balance"}).find("4.0 N m: "), std::string::npos);
}

TEST(LimberPackage, PkgConfigCompilesAndOnlyTheInterfaceIsExported) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer || is_emulated(), kReason);
  const TempFolder folder;
  const std::string prefix = folder.path() + "/prefix";
  install(prefix);
  const std::string package = std::filesystem::path(find_file(prefix, "limber.pc")).parent_path().string();
  const std::string program = folder.path() + "/sway";
  succeed({"sh", "-c",
           fmt::format("PKG_CONFIG_PATH={} && export PKG_CONFIG_PATH && cc {}/docs/examples/library/sway.c -o {} "
                       "$(pkg-config --cflags --libs limber)",
                       package, LIMBER_SOURCE_DIR, program)});
  const std::string library = find_file(prefix, "liblimber.so");
  succeed({"env", "LD_LIBRARY_PATH=" + std::filesystem::path(library).parent_path().string(), program});
  const std::string symbols =
      succeed({"sh", "-c", "nm -D --defined-only --format=posix " + library + " | cut -d' ' -f1"});
  int count = 0;
  for (std::size_t begin = 0; begin < symbols.size();) {
    const std::size_t end = symbols.find('\n', begin);
    const std::string symbol = symbols.substr(begin, end - begin);
    EXPECT_TRUE(symbol.starts_with("limber_") || symbol.starts_with("LIMBER_")) << symbol;
    count++;
    begin = end + 1;
  }
  EXPECT_GE(count, 29);
}

#ifdef LIMBER_PYTHON
TEST(LimberPackage, PythonPackageKeepsItsRules) {
  for (const char* tests : {"/tests/lib/python_protocol.py", "/tests/lib/python_policy.py"}) {
    const RunResult result = Process({"env", "PYTHONPATH=" LIMBER_BUILD "/python", "PYTHONDONTWRITEBYTECODE=1",
                                      LIMBER_PYTHON, "-W", "error", std::string(LIMBER_SOURCE_DIR) + tests})
                                 .finish();
    EXPECT_EQ(result.code, 0) << result.out << result.err;
  }
}

// As after pip install --target, but also where pip is missing.
TEST(LimberPackage, WheelWorksWithoutTheBuildFolder) {
  const TempFolder folder;
  const std::string site = folder.path() + "/site";
  std::string wheel =
      succeed({LIMBER_PYTHON, LIMBER_SOURCE_DIR "/.ci/package/wheel.py", LIMBER_BUILD, folder.path() + "/wheels"});
  ASSERT_TRUE(wheel.ends_with("-linux_x86_64.whl\n") || wheel.ends_with("-linux_aarch64.whl\n")) << wheel;
  wheel.pop_back();
  succeed({LIMBER_PYTHON, "-m", "zipfile", "-e", wheel, site});
  const std::string hash =
      succeed({LIMBER_PROGRAM, "scripts/arms.lua", "--fast", "--hash", "--ticks", "120", "--seed", "3"});
  EXPECT_EQ(succeed({"env", "-C", folder.path(), "PYTHONPATH=" + site, "PYTHONDONTWRITEBYTECODE=1", LIMBER_PYTHON, "-W",
                     "error", LIMBER_SOURCE_DIR "/.ci/package/python_check.py", site, hash}),
            "ok\n");
  // every file has its hash in RECORD, and none is missing there
  succeed({LIMBER_PYTHON, "-c", R"(
import base64, csv, hashlib, io, sys, zipfile
wheel = zipfile.ZipFile(sys.argv[1])
record = next(name for name in wheel.namelist() if name.endswith(".dist-info/RECORD"))
rows = {row[0]: row for row in csv.reader(io.StringIO(wheel.read(record).decode()))}
assert sorted(rows) == sorted(wheel.namelist())
for name, digest, size in rows.values():
    if name == record: continue
    data = wheel.read(name)
    expected = "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    assert (digest, int(size)) == (expected, len(data)), name
licenses = [name for name in rows if "/licenses/" in name]
assert len(licenses) > len([name for name in rows if name.startswith("limber/lib/")]), licenses
)",
           wheel});
}
#endif

}  // namespace
}  // namespace limber::lib::test
