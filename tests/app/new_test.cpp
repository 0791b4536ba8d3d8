// `limber new`: what it makes runs, says what comes next, and nothing that is there is written over.
#include <lua.hpp>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/paths.h"
#include "app/program.h"

namespace limber::app_test {
namespace {

namespace fs = std::filesystem;

Ran play(const fs::path& scene) { return run({scene.string(), "--fast", "--ticks", "60", "--strict", "--hash"}, "/"); }

TEST(New, ShellWordsSurviveAShell) {
  EXPECT_EQ(shell_word("/usr/bin/limber"), "/usr/bin/limber");
  EXPECT_EQ(shell_word("my show"), "'my show'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(New, AShowIsWholeAndPlays) {
  const Folder folder;
  const Ran made = run({"new", "show", "my show"}, folder.path());
  EXPECT_EQ(made.code, 0) << made.err;
  const fs::path show = fs::path(folder.path()) / "my show";
  for (const char* file :
       {"scripts/main.lua", "urdf/reed.urdf", "behaviors_lua/README.md", "README.md", ".luarc.json"}) {
    EXPECT_TRUE(fs::is_regular_file(show / file)) << file;
    EXPECT_EQ(content(show / file).find("{{"), std::string::npos) << file << " has a gap";
    EXPECT_NE(made.out.find(std::string("my show/") + file + "\n"), std::string::npos) << made.out;
  }
  EXPECT_TRUE(made.out.ends_with("\nNext:  cd 'my show' && " LIMBER_PROGRAM " play scripts/main.lua\n")) << made.out;
  EXPECT_TRUE(content(show / "README.md").starts_with("# my show\n"));
  const Ran played = play(show / "scripts/main.lua");
  EXPECT_EQ(played.code, 0) << played.err;
  EXPECT_NE(played.out.find(" tick 60\n"), std::string::npos);
  const Ran inspected = run({"inspect", (show / "urdf/reed.urdf").string(), "--json"});
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  const auto problems = nlohmann::json::parse(inspected.out)["problems"];
  EXPECT_EQ(problems.size(), 1U) << "only the note that a root without mass stands fast: " << problems;
}

TEST(New, WhatItPrintsNextRunsInAShell) {
  const Folder folder;
  const std::string program = install_copy(folder);
  for (const auto& [path, command] :
       {std::pair(std::string("/usr/bin:/bin"), program),
        std::pair(fs::path(program).parent_path().string() + ":/usr/bin:/bin", std::string("limber"))}) {
    const std::string name = command == "limber" ? "it's here" : "elsewhere";
    const Ran made = Running({"env", "PATH=" + path, program, "new", "show", name}, folder.path()).finish();
    EXPECT_NE(made.out.find(" && " + command + " play scripts/main.lua\n"), std::string::npos) << made.out;
    const std::string line = made.out.substr(made.out.find("Next:  ") + 7);
    const Ran played =
        Running({"env", "PATH=" + path, "sh", "-c", line.substr(0, line.size() - 1) + " --fast --ticks 1 --hash"},
                folder.path())
            .finish();
    EXPECT_NE(played.out.find(" tick 1\n"), std::string::npos) << played.out << played.err;
  }
}

TEST(New, AShowTellsEditorsWhereTheDefinitionsAre) {
  const Folder folder;
  ASSERT_EQ(run({"new", "show", "."}, folder.path()).code, 0) << "an empty folder will do";
  const auto settings = nlohmann::json::parse(content(fs::path(folder.path()) / ".luarc.json"));
  ASSERT_EQ(settings["workspace.library"].size(), 1U);
  const fs::path library = settings["workspace.library"][0].get<std::string>();
  EXPECT_TRUE(library.is_absolute());
  EXPECT_TRUE(fs::is_regular_file(library / "limber.d.lua")) << library;
  EXPECT_EQ(settings["runtime.version"], "LuaJIT");
  // the checkout's own settings say the same, but for its folders
  auto ours = nlohmann::json::parse(content(LIMBER_SOURCE_DIR "/.luarc.json"));
  EXPECT_TRUE(fs::is_regular_file(fs::path(LIMBER_SOURCE_DIR) / ours["workspace.library"][0].get<std::string>() /
                                  "limber.d.lua"));
  for (const char* key : {"runtime.version", "runtime.builtin", "diagnostics.globals"})
    EXPECT_EQ(ours[key], settings[key]) << key;
}

TEST(New, AnInstalledProgramPointsToWhatIsInstalled) {
  const Folder folder;
  const std::string program = install_copy(folder);
  ASSERT_EQ(Running({program, "new", "show", "s"}, folder.path()).finish().code, 0);
  const auto settings = nlohmann::json::parse(content(fs::path(folder.path()) / "s/.luarc.json"));
  EXPECT_EQ(fs::path(settings["workspace.library"][0].get<std::string>()),
            fs::path(folder.path()) / "share/limber/scripts/library");
}

TEST(New, ASceneGoesIntoTheShowAround) {
  const Folder folder;
  folder.file("scripts/lib/steps.lua", "return 1\n");
  const Ran made = run({"new", "scene", "dance.lua"}, folder.path() + "/scripts/lib");
  EXPECT_EQ(made.code, 0) << made.err;
  const fs::path scene = fs::path(folder.path()) / "scripts/dance.lua";
  EXPECT_EQ(made.out, scene.string() + "\n\nNext:  " LIMBER_PROGRAM " play " + scene.string() + "\n");
  EXPECT_TRUE(content(scene).starts_with("-- dance: "));
  const Ran played = play(scene);
  EXPECT_EQ(played.code, 0) << played.err;
}

TEST(New, ABehaviorDoesWhatItSays) {
  const Folder folder;
  folder.file("scripts/s.lua", "");
  const Ran made = run({"new", "behavior", "wave"}, folder.path());
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(made.out.ends_with("\nNext:  in a scene, body:add_behavior(\"wave\", \"my_wave\")\n")) << made.out;
  const std::string text = content(fs::path(folder.path()) / "behaviors_lua/wave.lua");
  EXPECT_TRUE(text.starts_with("-- wave: "));
  // two steps of half a second at 0.25 Hz: a quarter of a turn; motor i lags by i times 0.5
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

TEST(New, NothingIsWrittenOver) {
  const Folder folder;
  folder.file("scripts/dance.lua", "mine");
  folder.file("behaviors_lua/wave.lua", "mine");
  folder.file("show/file", "mine");
  const fs::path root = folder.path();
  Ran ran = run({"new", "scene", "dance"}, folder.path());
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.err, "limber: new: " + (root / "scripts/dance.lua").string() +
                         " is there already and stays as it is; choose another name\n");
  EXPECT_EQ(run({"new", "behavior", "wave"}, folder.path()).code, 1);
  ran = run({"new", "show", "show"}, folder.path());
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.err, "limber: new: show is there already; name a folder that is new or empty\n");
  EXPECT_EQ(run({"new", "show", "show/file"}, folder.path()).code, 1);
  for (const char* file : {"scripts/dance.lua", "behaviors_lua/wave.lua", "show/file"})
    EXPECT_EQ(content(root / file), "mine") << file;
  // not even behind a link that leads nowhere
  fs::create_symlink(root / "elsewhere.lua", root / "scripts/link.lua");
  EXPECT_EQ(run({"new", "scene", "link"}, folder.path()).code, 1);
  EXPECT_FALSE(fs::exists(root / "elsewhere.lua"));
}

TEST(New, NamesAreChecked) {
  const Folder folder;
  folder.file("scripts/s.lua", "");
  for (const char* name : {"", "Dance", "my dance", "../x", "a/b", "9lives", "_x", "dänce", ".lua", "x.lua.lua"}) {
    const Ran ran = run({"new", "scene", name}, folder.path());
    EXPECT_EQ(ran.code, 2) << name;
    EXPECT_NE(ran.err.find("can't be a scene's name: it has small letters, digits and _"), std::string::npos)
        << name << ": " << ran.err;
  }
  EXPECT_EQ(run({"new", "behavior", std::string(65, 'x')}, folder.path()).code, 2);
  EXPECT_EQ(run({"new", "behavior", std::string(64, 'x')}, folder.path()).code, 0);
  EXPECT_TRUE(run({"new", "scene", "My Dance!"}, folder.path()).err.ends_with("; such as 'my_dance'\n"));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(fs::path(folder.path()) / "scripts")) files++;
  EXPECT_EQ(files, 1U);
}

TEST(New, ABehaviorIsNotCalledLikeAnotherType) {
  const Folder folder;
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
      {"lua_force", "'lua_force' is a behavior that comes with Limber, and scenes count on it: " + twin},
      {"luaforce",
       "'luaforce' means 'lua_force', which is a behavior that comes with Limber, and scenes count on it: " + twin},
      {"sway",
       "'sway' means 'Sway_Behavior', which is there already: " + (root / "behaviors_lua/Sway_Behavior.lua").string()},
  };
  for (const auto& each : taken) {
    const Ran ran = run({"new", "behavior", each.name}, folder.path() + "/scripts");
    EXPECT_EQ(ran.code, 1) << each.name;
    EXPECT_EQ(ran.err, "limber: new: " + each.why + cure);
    EXPECT_EQ(ran.out, "") << each.name;
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(root / "behaviors_lua")) files++;
  EXPECT_EQ(files, 1U);
  // scenes have names of their own
  EXPECT_EQ(run({"new", "scene", "force"}, folder.path()).code, 0);
}

TEST(New, WhatTakesThePlaceOfAShippedOneSaysSo) {
  const Folder folder;
  folder.file("scripts/s.lua", "");
  const Ran ran = run({"new", "behavior", "breathe"}, folder.path());
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.err,
            "limber: new: note: in this show it takes the place of " LIMBER_SOURCE_DIR "/behaviors_lua/breathe.lua\n");
  EXPECT_EQ(run({"new", "behavior", "gust"}, folder.path()).err, "");
}

TEST(New, PlacesThatCantBeAreRefused) {
  const Folder folder;
  folder.file("scripts/s.lua", "");
  folder.file("file", "mine");
  const fs::path root = folder.path();
  for (const char* name : {"", "my\nshow", "\x1b[2J", "\xff\xfe"}) {
    const Ran ran = run({"new", "show", name}, folder.path());
    EXPECT_EQ(ran.code, 2) << name;
    EXPECT_NE(ran.err.find("can't be a show's folder: its name is printable text; such as my_show"), std::string::npos)
        << ran.err;
  }
  // below a file, and of a name that no file system takes
  Ran ran = run({"new", "show", "file/show"}, folder.path());
  EXPECT_EQ(ran.code, 1);
  EXPECT_NE(ran.err.find(" can't be written: Not a directory; choose another place\n"), std::string::npos) << ran.err;
  ran = run({"new", "show", std::string(300, 'x')}, folder.path());
  EXPECT_EQ(ran.code, 1);
  EXPECT_NE(ran.err.find(" can't be written: File name too long; choose another place\n"), std::string::npos)
      << ran.err;
  // where nobody may make anything
  ran = run({"new", "show", "/proc/limber_show"}, folder.path());
  EXPECT_EQ(ran.code, 3);
  EXPECT_NE(ran.err.find("/proc/limber_show/"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("; look at the folder's permissions\n"), std::string::npos) << ran.err;
  // a folder that has the scene's name is not written over either
  fs::create_directories(root / "scripts/taken.lua");
  EXPECT_EQ(run({"new", "scene", "taken"}, folder.path()).code, 1);
  EXPECT_EQ(content(root / "file"), "mine");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(root)) files++;
  EXPECT_EQ(files, 2U) << "scripts and the file, nothing half made";
}

TEST(New, WithoutAShowThereIsNoPlaceForAScene) {
  const Folder folder;
  const Ran ran = run({"new", "scene", "dance"}, folder.path());
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.err,
            "limber: new: there is no show here: go into one (a folder that holds scripts/), or make one: limber new "
            "show DIR\n");
  EXPECT_EQ(run({"new"}).code, 2);
  EXPECT_EQ(run({"new", "robot", "x"}).code, 2);
  EXPECT_EQ(run({"new", "show"}).code, 2);
}

}  // namespace
}  // namespace limber::app_test
