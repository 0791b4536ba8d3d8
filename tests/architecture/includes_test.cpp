// A room looks down, never up, never sideways, and each outside library is included by one room.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "architecture/source_rules.h"

namespace limber::rules {
namespace {

TEST(Includes, EveryFileOfTheTreeLooksDown) {
  const std::vector<SourceFile> files = source_files("src", {".h", ".hpp", ".cpp", ".inc"});
  ASSERT_GT(files.size(), 10U) << "the tree was not found";
  for (const SourceFile& file : files) {
    for (const std::string& complaint : include_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
  }
}

TEST(Includes, OnlyTheSystemLayerCallsTheOperatingSystem) {
  for (const SourceFile& file : source_files("src", {".h", ".hpp", ".cpp", ".inc"})) {
    for (const std::string& complaint : system_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
  }
  // planted
  EXPECT_EQ(system_complaints("src/app/a.cpp", "//\nint a = getpid();\n"),
            std::vector<std::string>{"src/app/a.cpp:2: 'getpid(' is the operating system's: call it in "
                                     "src/base/system/"});
  for (const char* line :
       {"pthread_kill(a, 1);", "ssize_t n = 0;", "f(\"/proc/self/exe\");", "if (::sendmmsg(a)) b();"})
    EXPECT_EQ(system_complaints("src/osc/a.cpp", line).size(), 1U) << line;
  for (const char* line : {"// getpid() is elsewhere", "target_pid_t = 1;", "my_getpid();", "window.poll(1);"})
    EXPECT_TRUE(system_complaints("src/osc/a.cpp", line).empty()) << line;
  EXPECT_TRUE(system_complaints("src/base/system/process.cpp", "return getpid();").empty());
}

TEST(Includes, EveryFolderOfSrcIsARoom) {
  const std::vector<std::string> known = rooms();
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/src")) {
    if (!entry.is_directory()) continue;
    const std::string name = entry.path().filename().string();
    EXPECT_NE(std::find(known.begin(), known.end(), name), known.end())
        << "src/" << name << " is no room: give it a row in source_rules.cpp and a place in CMakeLists.txt";
  }
}

/// A file, one line in it, and a word of the complaint; no word: it is allowed.
struct Planted {
  const char* path;
  const char* line;
  const char* complaint;
};

TEST(Includes, PlantedOnesAreFound) {
  const std::vector<Planted> planted{
      // upwards
      {"src/base/log.cpp", "#include \"params/table.h\"", "looks up"},
      {"src/params/store.cpp", "#include \"sim/world.h\"", "looks up"},
      {"src/sim/world.h", "#include \"engine/engine.h\"", "looks up"},
      {"src/engine/engine.cpp", "#include \"osc/send.h\"", "looks up"},
      {"src/gui/gui.cpp", "#include \"app/app.h\"", "looks up"},
      // sideways
      {"src/params/store.cpp", "#include \"model/body_model.h\"", "sideways"},
      {"src/script/vm.cpp", "#include \"behaviors/force.h\"", "sideways"},
      {"src/osc/send.cpp", "#include \"query/server.h\"", "sideways"},
      // the outside sees nothing live
      {"src/osc/receive.cpp", "#include \"sim/part.h\"", "sideways"},
      {"src/view/scene.cpp", "#include \"script/vm.h\"", "sideways"},
      // an outside library in the wrong room
      {"src/engine/engine.cpp", "#include <btBulletDynamicsCommon.h>", "room sim"},
      {"src/model/hull.cpp", "#include <LinearMath/btConvexHullComputer.h>", "room sim"},
      {"src/sim/body.cpp", "#include <urdf_parser/urdf_parser.h>", "room model"},
      {"src/sim/body.cpp", "#include <assimp/Importer.hpp>", "no known library"},
      {"src/app/options.cpp", "#include <tinyxml2.h>", "room model"},
      {"src/engine/engine.cpp", "#include <lua.hpp>", "room script"},
      {"src/query/server.cpp", "#include <oscpack/osc/OscOutboundPacketStream.h>", "room osc"},
      {"src/sim/world.cpp", "#include <spdlog/spdlog.h>", "room base"},
      {"src/engine/clock.cpp", "#include <GLFW/glfw3.h>", "room app"},
      {"src/sim/world.cpp", "#include <Eigen/Dense>", "no known library"},
      // the operating system outside its layer
      {"src/osc/receive.cpp", "#include <sys/socket.h>", "src/base/system/"},
      {"src/base/arena.cpp", "#include <sys/mman.h>", "src/base/system/"},
      {"src/app/play.cpp", "#include <pthread.h>", "src/base/system/"},
      {"src/script/determinism.cpp", "#include <dlfcn.h>", "src/base/system/"},
      // not from src/, no room, or hidden behind blanks
      {"src/sim/world.cpp", "#include \"body.h\"", "written from src/"},
      {"src/sim/world.cpp", "#include \"../engine/engine.h\"", "written from src/"},
      {"src/sim/world.cpp", "#include \"physics/body.h\"", "no room"},
      {"src/sim/world.cpp", "  #  include\t\"engine/engine.h\"  // why not", "looks up"},
      {"src/physics/world.cpp", "", "no such room"},
  };
  for (const Planted& p : planted) {
    const std::vector<std::string> complaints =
        include_complaints(p.path, "// what it is\n\n" + std::string(p.line) + "\n");
    ASSERT_EQ(complaints.size(), 1U) << p.path << " with " << p.line;
    EXPECT_NE(complaints[0].find(p.complaint), std::string::npos) << complaints[0];
    EXPECT_TRUE(complaints[0].starts_with(p.path)) << complaints[0];
  }
  // and it says in which line
  EXPECT_EQ(include_complaints("src/base/a.cpp", "//\n//\n\n#include \"sim/a.h\"\n")[0],
            "src/base/a.cpp:4: 'sim/a.h' looks up or sideways: base sees base ");
}

TEST(Includes, GoodOnesAreNot) {
  const std::vector<Planted> allowed{
      {"src/base/log.cpp", "#include <spdlog/spdlog.h>", nullptr},
      {"src/sim/world.cpp", "#include \"model/body_model.h\"", nullptr},
      {"src/sim/bullet.h", "#include <btBulletDynamicsCommon.h>", nullptr},
      {"src/behaviors/force.cpp", "#include \"sim/behavior.h\"", nullptr},
      {"src/engine/engine.cpp", "#include \"script/vm.h\"", nullptr},
      {"src/osc/receive.cpp", "#include \"engine/command.h\"", nullptr},
      {"src/base/system/socket.cpp", "#include <sys/socket.h>", nullptr},
      {"src/sim/dense.cpp", "#include <immintrin.h>", nullptr},
      {"src/app/app.cpp", "#include \"osc/receive.h\"", nullptr},
      {"src/main.cpp", "#include \"app/app.h\"", nullptr},
      {"src/script/vm.cpp", "#include <lua.hpp>", nullptr},
      {"src/query/json.cpp", "#include <nlohmann/json.hpp>", nullptr},
      {"src/base/vec.h", "#include <cmath>", nullptr},
      {"src/base/log.cpp", "// an old tale of #include \"sim/world.h\"", nullptr},
  };
  for (const Planted& p : allowed) {
    const std::vector<std::string> complaints = include_complaints(p.path, p.line);
    EXPECT_TRUE(complaints.empty()) << complaints[0];
  }
}

}  // namespace
}  // namespace limber::rules
