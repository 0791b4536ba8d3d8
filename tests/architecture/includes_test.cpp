// Modules include lower layers only, and each external library is included by one module.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "architecture/source_rules.h"

namespace limber::rules {
namespace {

TEST(Includes, EveryFileIncludesLowerModulesOnly) {
  const std::vector<SourceFile> files = source_files("src", {".h", ".hpp", ".cpp", ".inc"});
  ASSERT_GT(files.size(), 10U) << "the tree was not found";
  for (const SourceFile& file : files) {
    for (const std::string& complaint : include_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
  }
}

TEST(Includes, LibrariesStayInTheirModules) {
  const std::vector<SourceFile> files = source_files("src", {".h", ".cpp", ".inc"});
  ASSERT_GT(files.size(), 10U) << "the tree was not found";
  for (const std::string& complaint : indirect_include_complaints(files)) ADD_FAILURE() << complaint;
  // a violation, through two headers
  const std::vector<SourceFile> planted{
      {"src/sim/bullet/bullet.h", "#include <btBulletDynamicsCommon.h>\n"},
      {"src/sim/world/part.h", "#include \"sim/bullet/bullet.h\"\n"},
      {"src/sim/world/part.cpp", "#include \"sim/world/part.h\"\n"},
      {"src/engine/engine.cpp", "#include \"sim/world/part.h\"\n"},
  };
  EXPECT_EQ(indirect_include_complaints(planted),
            std::vector<std::string>{"src/engine/engine.cpp: includes 'btBulletDynamicsCommon.h' through "
                                     "'sim/bullet/bullet.h', which may be included by the module sim only"});
}

TEST(Includes, OnlyTheSystemLayerCallsTheOperatingSystem) {
  for (const SourceFile& file : source_files("src", {".h", ".hpp", ".cpp", ".inc"})) {
    for (const std::string& complaint : system_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
  }
  // violations
  EXPECT_EQ(system_complaints("src/app/a.cpp", "//\nint a = getpid();\n"),
            std::vector<std::string>{"src/app/a.cpp:2: 'getpid(' belongs to the operating system: call it in "
                                     "src/base/system/"});
  for (const char* line :
       {"pthread_kill(a, 1);", "ssize_t n = 0;", "f(\"/proc/self/exe\");", "if (::sendmmsg(a)) b();"})
    EXPECT_EQ(system_complaints("src/net/osc/a.cpp", line).size(), 1U) << line;
  for (const char* line : {"// getpid() is elsewhere", "target_pid_t = 1;", "my_getpid();", "window.poll(1);"})
    EXPECT_TRUE(system_complaints("src/net/osc/a.cpp", line).empty()) << line;
  EXPECT_TRUE(system_complaints("src/base/system/process.cpp", "return getpid();").empty());
}

TEST(Includes, EveryFileBelongsToAModule) {
  const std::vector<std::string> known = modules();
  for (const SourceFile& file : source_files("src", {".h", ".cpp", ".lua"})) {
    if (file.path == "src/main.cpp") continue;
    EXPECT_TRUE(
        std::ranges::any_of(known, [&](const std::string& name) { return file.path.starts_with("src/" + name + "/"); }))
        << file.path << " is in an unknown module: add it to source_rules.cpp and CMakeLists.txt";
  }
}

/// A file, one line of it, and a part of the expected complaint; null: the line is allowed.
struct IncludeCase {
  const char* path;
  const char* line;
  const char* complaint;
};

TEST(Includes, ViolationsAreFound) {
  const std::vector<IncludeCase> planted{
      // a higher layer
      {"src/base/log/log.cpp", "#include \"properties/property_table.h\"", "not in a lower module"},
      {"src/properties/store.cpp", "#include \"sim/world/world.h\"", "not in a lower module"},
      {"src/sim/world/world.h", "#include \"engine/engine.h\"", "not in a lower module"},
      {"src/engine/engine.cpp", "#include \"net/osc/send.h\"", "not in a lower module"},
      {"src/ui/panel/gui.cpp", "#include \"app/app.h\"", "not in a lower module"},
      // an unrelated module
      {"src/properties/store.cpp", "#include \"model/body_model.h\"", "not in a lower module"},
      {"src/script/vm/vm.cpp", "#include \"engine/engine.h\"", "not in a lower module"},
      {"src/net/osc/send.cpp", "#include \"net/oscquery/server.h\"", "not in a lower module"},
      // a folder of internal headers
      {"src/engine/engine.cpp", "#include \"sim/solver/forest.h\"", "is internal to sim"},
      {"src/app/show/play.cpp", "#include \"ui/panel/panels/time.h\"", "is internal to ui/panel"},
      // modules outside the simulation thread have no access to simulation objects
      {"src/net/osc/receive.cpp", "#include \"sim/world/part.h\"", "not in a lower module"},
      {"src/ui/render/scene.cpp", "#include \"script/vm/vm.h\"", "not in a lower module"},
      // an external library in the wrong module
      {"src/engine/engine.cpp", "#include <btBulletDynamicsCommon.h>", "module sim only"},
      {"src/model/mesh/hull.cpp", "#include <LinearMath/btConvexHullComputer.h>", "module sim only"},
      {"src/sim/world/body.cpp", "#include <urdf_parser/urdf_parser.h>", "no known library"},
      {"src/sim/world/body.cpp", "#include <assimp/Importer.hpp>", "no known library"},
      {"src/app/cli/options.cpp", "#include <tinyxml2.h>", "module model only"},
      {"src/engine/engine.cpp", "#include <lua.hpp>", "module script only"},
      {"src/net/oscquery/server.cpp", "#include <oscpack/osc/OscOutboundPacketStream.h>", "no known library"},
      {"src/engine/clock.cpp", "#include <GLFW/glfw3.h>", "module app only"},
      {"src/sim/world/world.cpp", "#include <Eigen/Dense>", "no known library"},
      // system headers outside the system layer
      {"src/net/osc/receive.cpp", "#include <sys/socket.h>", "src/base/system/"},
      {"src/base/memory/arena.cpp", "#include <sys/mman.h>", "src/base/system/"},
      {"src/app/show/play.cpp", "#include <pthread.h>", "src/base/system/"},
      {"src/script/determinism.cpp", "#include <dlfcn.h>", "src/base/system/"},
      // a path that is not relative to src/, an unknown module, or leading blanks
      {"src/sim/world/world.cpp", "#include \"body.h\"", "relative to src/"},
      {"src/sim/world/world.cpp", "#include \"../engine/engine.h\"", "relative to src/"},
      {"src/sim/world/world.cpp", "#include \"physics/body.h\"", "in no module"},
      {"src/sim/world/world.cpp", "  #  include\t\"engine/engine.h\"  // why not", "not in a lower module"},
      {"src/physics/world.cpp", "", "unknown module"},
  };
  for (const IncludeCase& p : planted) {
    const std::vector<std::string> complaints =
        include_complaints(p.path, "// a test\n\n" + std::string(p.line) + "\n");
    ASSERT_EQ(complaints.size(), 1U) << p.path << " with " << p.line;
    EXPECT_NE(complaints[0].find(p.complaint), std::string::npos) << complaints[0];
    EXPECT_TRUE(complaints[0].starts_with(p.path)) << complaints[0];
  }
  // with the line number
  EXPECT_EQ(include_complaints("src/base/a.cpp", "//\n//\n\n#include \"sim/a.h\"\n")[0],
            "src/base/a.cpp:4: 'sim/a.h' is not in a lower module: base may include base ");
}

TEST(Includes, AllowedIncludesPass) {
  const std::vector<IncludeCase> allowed{
      {"src/base/log/log.cpp", "#include <fmt/format.h>", nullptr},
      {"src/sim/world/world.cpp", "#include \"model/body_model.h\"", nullptr},
      {"src/sim/bullet/bullet.h", "#include <btBulletDynamicsCommon.h>", nullptr},
      {"src/sim/behavior/builtin/force.cpp", "#include \"sim/behavior/behavior.h\"", nullptr},
      {"src/engine/engine.cpp", "#include \"script/vm/vm.h\"", nullptr},
      {"src/net/osc/receive.cpp", "#include \"engine/commands/command.h\"", nullptr},
      {"src/base/system/net/socket.cpp", "#include <sys/socket.h>", nullptr},
      {"src/sim/solver/lcp/dense_kernels.cpp", "#include <immintrin.h>", nullptr},
      {"src/app/app.cpp", "#include \"net/osc/receive.h\"", nullptr},
      {"src/main.cpp", "#include \"app/app.h\"", nullptr},
      {"src/script/vm/vm.cpp", "#include <lua.hpp>", nullptr},
      {"src/net/oscquery/json.cpp", "#include <nlohmann/json.hpp>", nullptr},
      {"src/base/vec.h", "#include <cmath>", nullptr},
      {"src/base/log/log.cpp", "// a comment with #include \"sim/world/world.h\"", nullptr},
  };
  for (const IncludeCase& p : allowed) {
    const std::vector<std::string> complaints = include_complaints(p.path, p.line);
    EXPECT_TRUE(complaints.empty()) << complaints[0];
  }
}

}  // namespace
}  // namespace limber::rules
