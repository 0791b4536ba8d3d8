// `limber new`: its files work, it prints the next step, and it never overwrites a file.
#include <lua.hpp>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/paths.h"
#include "app/program.h"

namespace limber::app::test {
namespace {

namespace fs = std::filesystem;

RunResult play(const fs::path& scene) {
  return run({scene.string(), "--fast", "--ticks", "60", "--strict", "--hash"}, "/");
}

TEST(New, QuotesWordsForAShell) {
  EXPECT_EQ(shell_word("/usr/bin/limber"), "/usr/bin/limber");
  EXPECT_EQ(shell_word("my show"), "'my show'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(New, CreatesACompleteShow) {
  const TempFolder folder;
  const RunResult made = run({"new", "show", "my show"}, folder.path());
  EXPECT_EQ(made.code, 0) << made.err;
  const fs::path show = fs::path(folder.path()) / "my show";
  for (const char* file :
       {"scripts/main.lua", "urdf/reed.urdf", "behaviors_lua/README.md", "README.md", ".luarc.json"}) {
    EXPECT_TRUE(fs::is_regular_file(show / file)) << file;
    EXPECT_EQ(content(show / file).find("{{"), std::string::npos) << file << " has an unfilled placeholder";
    EXPECT_NE(made.out.find(std::string("my show/") + file + "\n"), std::string::npos) << made.out;
  }
  EXPECT_TRUE(made.out.ends_with("\nNext:  cd 'my show' && " LIMBER_PROGRAM " play scripts/main.lua\n")) << made.out;
  EXPECT_TRUE(content(show / "README.md").starts_with("# my show\n"));
  const RunResult played = play(show / "scripts/main.lua");
  EXPECT_EQ(played.code, 0) << played.err;
  EXPECT_NE(played.out.find(" tick 60\n"), std::string::npos);
  const RunResult inspected = run({"inspect", (show / "urdf/reed.urdf").string(), "--json"});
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  const auto problems = nlohmann::json::parse(inspected.out)["problems"];
  EXPECT_EQ(problems.size(), 1U) << "only the note that a root without mass is static: " << problems;
}

TEST(New, PrintsACommandThatRunsInAShell) {
  const TempFolder folder;
  const std::string program = install_copy(folder);
  for (const auto& [path, command] :
       {std::pair(std::string("/usr/bin:/bin"), program),
        std::pair(fs::path(program).parent_path().string() + ":/usr/bin:/bin", std::string("limber"))}) {
    const std::string name = command == "limber" ? "it's here" : "elsewhere";
    const RunResult made = Process({"env", "PATH=" + path, program, "new", "show", name}, folder.path()).finish();
    EXPECT_NE(made.out.find(" && " + command + " play scripts/main.lua\n"), std::string::npos) << made.out;
    const std::string line = made.out.substr(made.out.find("Next:  ") + 7);
    const RunResult played =
        Process({"env", "PATH=" + path, "sh", "-c", line.substr(0, line.size() - 1) + " --fast --ticks 1 --hash"},
                folder.path())
            .finish();
    EXPECT_NE(played.out.find(" tick 1\n"), std::string::npos) << played.out << played.err;
  }
}

TEST(New, EditorSettingsPointToTheDefinitions) {
  const TempFolder folder;
  ASSERT_EQ(run({"new", "show", "."}, folder.path()).code, 0) << "an empty folder is accepted";
  const auto settings = nlohmann::json::parse(content(fs::path(folder.path()) / ".luarc.json"));
  ASSERT_EQ(settings["workspace.library"].size(), 1U);
  const fs::path library = settings["workspace.library"][0].get<std::string>();
  EXPECT_TRUE(library.is_absolute());
  EXPECT_TRUE(fs::is_regular_file(library / "limber.d.lua")) << library;
  EXPECT_EQ(settings["runtime.version"], "LuaJIT");
  // the settings of the checkout are the same except for the folders
  auto ours = nlohmann::json::parse(content(LIMBER_SOURCE_DIR "/.luarc.json"));
  EXPECT_TRUE(fs::is_regular_file(fs::path(LIMBER_SOURCE_DIR) / ours["workspace.library"][0].get<std::string>() /
                                  "limber.d.lua"));
  for (const char* key : {"runtime.version", "runtime.builtin", "diagnostics.globals"})
    EXPECT_EQ(ours[key], settings[key]) << key;
}

TEST(New, InstalledProgramUsesInstalledDefinitions) {
  const TempFolder folder;
  const std::string program = install_copy(folder);
  ASSERT_EQ(Process({program, "new", "show", "s"}, folder.path()).finish().code, 0);
  const auto settings = nlohmann::json::parse(content(fs::path(folder.path()) / "s/.luarc.json"));
  EXPECT_EQ(fs::path(settings["workspace.library"][0].get<std::string>()),
            fs::path(folder.path()) / "share/limber/scripts/library");
}

TEST(New, CreatesASceneInTheEnclosingShow) {
  const TempFolder folder;
  folder.file("scripts/lib/steps.lua", "return 1\n");
  const RunResult made = run({"new", "scene", "dance.lua"}, folder.path() + "/scripts/lib");
  EXPECT_EQ(made.code, 0) << made.err;
  const fs::path scene = fs::path(folder.path()) / "scripts/dance.lua";
  EXPECT_EQ(made.out, scene.string() + "\n\nNext:  " LIMBER_PROGRAM " play " + scene.string() + "\n");
  EXPECT_TRUE(content(scene).starts_with("-- dance: "));
  const RunResult played = play(scene);
  EXPECT_EQ(played.code, 0) << played.err;
}

TEST(New, CreatedBehaviorWorks) {
  const TempFolder folder;
  folder.file("scripts/s.lua", "");
  const RunResult made = run({"new", "behavior", "wave"}, folder.path());
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(made.out.ends_with("\nNext:  in a scene, body:add_behavior(\"wave\", \"my_wave\")\n")) << made.out;
  const std::string text = content(fs::path(folder.path()) / "behaviors_lua/wave.lua");
  EXPECT_TRUE(text.starts_with("-- wave: "));
  // two steps of half a second at 0.25 Hz: a quarter of a period; motor i lags by i times 0.5
  const std::unique_ptr<lua_State, decltype(&lua_close)> state(luaL_newstate(), &lua_close);
  lua_State* const L = state.get();
  luaL_openlibs(L);
  ASSERT_EQ(luaL_dostring(L, "function behavior(t) return t end"), 0);
  ASSERT_EQ(luaL_dostring(L, text.c_str()), 0) << lua_tostring(L, -1);
  lua_setglobal(L, "wave");
  ASSERT_EQ(luaL_dostring(L, R"(
    local self = { state = {}, motors = { {}, {} } }
    for i, each in ipairs(wave.params) do
      self[each[1]] = each[2]
      assert(each[2] >= each.min and each[2] <= each.max and #each.doc > 0)
    end
    assert(#wave.doc > 0 and #wave.params == 3)
    wave.start(self)
    wave.step(self, 0.5)
    wave.step(self, 0.5)
    return self.depth, self.lag, self.motors[1].target, self.motors[2].target)"),
            0)
      << lua_tostring(L, -1);
  const double depth = lua_tonumber(L, -4);
  const double lag = lua_tonumber(L, -3);
  EXPECT_NEAR(lua_tonumber(L, -2), depth * std::cos(lag), 1e-12);
  EXPECT_NEAR(lua_tonumber(L, -1), depth * std::cos(2 * lag), 1e-12);
}

TEST(New, NeverOverwritesFiles) {
  const TempFolder folder;
  folder.file("scripts/dance.lua", "mine");
  folder.file("behaviors_lua/wave.lua", "mine");
  folder.file("show/file", "mine");
  const fs::path root = folder.path();
  RunResult result = run({"new", "scene", "dance"}, folder.path());
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err, "limber: new: " + (root / "scripts/dance.lua").string() +
                            " already exists and is not overwritten; choose another name\n");
  EXPECT_EQ(run({"new", "behavior", "wave"}, folder.path()).code, 1);
  result = run({"new", "show", "show"}, folder.path());
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err, "limber: new: show already exists; choose a new or empty folder\n");
  EXPECT_EQ(run({"new", "show", "show/file"}, folder.path()).code, 1);
  for (const char* file : {"scripts/dance.lua", "behaviors_lua/wave.lua", "show/file"})
    EXPECT_EQ(content(root / file), "mine") << file;
  // not even through a dangling link
  fs::create_symlink(root / "elsewhere.lua", root / "scripts/link.lua");
  EXPECT_EQ(run({"new", "scene", "link"}, folder.path()).code, 1);
  EXPECT_FALSE(fs::exists(root / "elsewhere.lua"));
}

TEST(New, ValidatesNames) {
  const TempFolder folder;
  folder.file("scripts/s.lua", "");
  for (const char* name : {"", "Dance", "my dance", "../x", "a/b", "9lives", "_x", "dänce", ".lua", "x.lua.lua"}) {
    const RunResult result = run({"new", "scene", name}, folder.path());
    EXPECT_EQ(result.code, 2) << name;
    EXPECT_NE(result.err.find("is not a valid scene name: use lower-case letters, digits and _"), std::string::npos)
        << name << ": " << result.err;
  }
  EXPECT_EQ(run({"new", "behavior", std::string(65, 'x')}, folder.path()).code, 2);
  EXPECT_EQ(run({"new", "behavior", std::string(64, 'x')}, folder.path()).code, 0);
  EXPECT_TRUE(run({"new", "scene", "My Dance!"}, folder.path()).err.ends_with("; such as 'my_dance'\n"));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(fs::path(folder.path()) / "scripts")) files++;
  EXPECT_EQ(files, 1U);
}

TEST(New, RejectsNamesOfExistingTypes) {
  const TempFolder folder;
  folder.file("scripts/s.lua", "");
  folder.file("behaviors_lua/Sway_Behavior.lua", "mine");
  const fs::path root = folder.path();
  const std::string cure = "; choose another name (case, underscores and a trailing 'behavior' make no difference)\n";
  const std::string twin = std::string(LIMBER_SOURCE_DIR) + "/behaviors_lua/lua_force.lua";
  const struct {
    const char* name;
    std::string why;
  } taken[] = {
      {"force", "'force' is a built-in behavior type"},
      {"for_ce", "'for_ce' means 'force', which is a built-in behavior type"},
      {"force_behavior.lua", "'force_behavior' means 'force', which is a built-in behavior type"},
      {"randomrotationtarget",
       "'randomrotationtarget' means 'random_rotation_target', which is a built-in behavior type"},
      {"cohesion", "'cohesion' is a built-in behavior type"},
      {"lua_force", "'lua_force' is a behavior of Limber that scenes depend on: " + twin},
      {"luaforce", "'luaforce' means 'lua_force', which is a behavior of Limber that scenes depend on: " + twin},
      {"sway", "'sway' means 'Sway_Behavior', which is an existing behavior: " +
                   (root / "behaviors_lua/Sway_Behavior.lua").string()},
  };
  for (const auto& each : taken) {
    const RunResult result = run({"new", "behavior", each.name}, folder.path() + "/scripts");
    EXPECT_EQ(result.code, 1) << each.name;
    EXPECT_EQ(result.err, "limber: new: " + each.why + cure);
    EXPECT_EQ(result.out, "") << each.name;
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(root / "behaviors_lua")) files++;
  EXPECT_EQ(files, 1U);
  // names of scenes are independent
  EXPECT_EQ(run({"new", "scene", "force"}, folder.path()).code, 0);
}

TEST(New, ReportsThatItReplacesAShippedBehavior) {
  const TempFolder folder;
  folder.file("scripts/s.lua", "");
  const RunResult result = run({"new", "behavior", "breathe"}, folder.path());
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err,
            "limber: new: note: in this show it replaces " LIMBER_SOURCE_DIR "/behaviors_lua/breathe.lua\n");
  EXPECT_EQ(run({"new", "behavior", "gust"}, folder.path()).err, "");
}

TEST(New, RejectsInvalidFolders) {
  const TempFolder folder;
  folder.file("scripts/s.lua", "");
  folder.file("file", "mine");
  const fs::path root = folder.path();
  for (const char* name : {"", "my\nshow", "\x1b[2J", "\xff\xfe"}) {
    const RunResult result = run({"new", "show", name}, folder.path());
    EXPECT_EQ(result.code, 2) << name;
    EXPECT_NE(result.err.find("is not a valid folder name: use printable text, such as my_show"), std::string::npos)
        << result.err;
  }
  // below a file, and with a name that is too long
  RunResult result = run({"new", "show", "file/show"}, folder.path());
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find(" can't be written: Not a directory; choose another place\n"), std::string::npos)
      << result.err;
  result = run({"new", "show", std::string(300, 'x')}, folder.path());
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find(" can't be written: File name too long; choose another place\n"), std::string::npos)
      << result.err;
  // in a folder where nothing can be created
  result = run({"new", "show", "/proc/limber_show"}, folder.path());
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("/proc/limber_show/"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("; check the folder's permissions\n"), std::string::npos) << result.err;
  // a folder with the scene's name isn't overwritten either
  fs::create_directories(root / "scripts/taken.lua");
  EXPECT_EQ(run({"new", "scene", "taken"}, folder.path()).code, 1);
  EXPECT_EQ(content(root / "file"), "mine");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(root)) files++;
  EXPECT_EQ(files, 2U) << "scripts and the file, no partial files";
}

TEST(New, SceneNeedsAShow) {
  const TempFolder folder;
  const RunResult result = run({"new", "scene", "dance"}, folder.path());
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err,
            "limber: new: no show found here. Change to its folder (which contains scripts/), or create one: limber "
            "new show DIR\n");
  EXPECT_EQ(run({"new"}).code, 2);
  EXPECT_EQ(run({"new", "robot", "x"}).code, 2);
  EXPECT_EQ(run({"new", "show"}).code, 2);
}

}  // namespace
}  // namespace limber::app::test
