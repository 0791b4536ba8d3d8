// limber sweep, and the output of limber play.
#include <algorithm>
#include <csignal>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/push_scene.h"

namespace limber::app::test {
namespace {

TEST(Sweep, TableHasTheResultsOfAllCombinations) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const RunResult result =
      run({"sweep", "push.lua", "--param", "push=1:2/2", "--param", "mass=0.5,2", "--seeds", "1:2", "--duration", "2"},
          folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<Row> table = rows(result.out);
  ASSERT_EQ(table.size(), 9u) << result.out;
  EXPECT_EQ(table[0], (Row{"number", "push", "mass", "seed", "distance", "noise", "hash", "error", "command"}));
  for (std::size_t i = 0; i < 8; i++) {
    const Row& row = table[i + 1];
    const double push = i / 4 == 0 ? 1 : 2;
    const double mass = i / 2 % 2 == 0 ? 0.5 : 2;
    EXPECT_EQ(row[0], std::to_string(i));
    EXPECT_EQ(std::stod(row[1]), push);
    EXPECT_EQ(std::stod(row[2]), mass);
    EXPECT_EQ(row[3], std::to_string(i % 2 + 1));
    EXPECT_NEAR(std::stod(row[4]), push * 2 / mass, 1e-4);
    EXPECT_EQ(row[7], "");
  }
  // the noise depends on the seed alone
  EXPECT_EQ(table[1][5], table[3][5]);
  EXPECT_NE(table[1][5], table[2][5]);
}

TEST(Sweep, RowsArePlayedByTheirCommands) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const RunResult result = run({"sweep", "push.lua", "--samples", "5", "--duration", "1"}, folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<Row> table = rows(result.out);
  ASSERT_EQ(table.size(), 6u);
  for (std::size_t i = 1; i < table.size(); i++) {
    std::istringstream words(table[i].back());
    std::vector<std::string> args;
    for (std::string word; words >> word;) args.push_back(word);
    ASSERT_EQ(args[0], "limber");
    args.erase(args.begin());
    args.insert(args.end(), {"--fast", "--duration", "1", "--hash"});
    const RunResult played = run(args, folder.path());
    EXPECT_EQ(played.code, 0) << played.err;
    EXPECT_NE(played.out.find("hash " + table[i][table[i].size() - 3] + " tick 60"), std::string::npos)
        << table[i].back() << "\n"
        << played.out;
    EXPECT_NE(played.out.find("result distance " + table[i][5] + "\n"), std::string::npos) << played.out;
  }
}

TEST(Sweep, TableIsTheSameForAnyNumberOfJobs) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  std::string first;
  for (const char* jobs : {"1", "2", "7"}) {
    const RunResult result =
        run({"sweep", "push.lua", "--design", "latin", "--samples", "20", "--duration", "0.5", "--jobs", jobs},
            folder.path());
    ASSERT_EQ(result.code, 0) << result.err;
    if (first.empty()) first = result.out;
    EXPECT_EQ(result.out, first);
  }
}

TEST(Sweep, ContinuesAfterTheTableWasCutAnywhere) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const std::vector<std::string> command{"sweep",      "push.lua", "--param", "push=0:4/9",
                                         "--duration", "0.5",      "--out",   "t.csv"};
  ASSERT_EQ(run(command, folder.path()).code, 0);
  const std::string whole = content(folder.path() + "/t.csv");
  const RunResult again = run(command, folder.path());
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.err.find("t.csv already exists: continue it with --resume"), std::string::npos) << again.err;
  std::vector<std::string> resume = command;
  resume.emplace_back("--resume");
  for (const std::size_t size : {whole.size() / 3, whole.size() / 2 + 7, whole.size() - 1, whole.size()}) {
    folder.file("t.csv", whole.substr(0, size));
    const RunResult result = run(resume, folder.path());
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(content(folder.path() + "/t.csv"), whole);
  }
}

TEST(Sweep, ATableOfAnotherSweepStaysAsItIs) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const auto sweep = [&](const std::string& push, const std::string& duration) {
    return run({"sweep", "push.lua", "--param", "push=" + push, "--duration", duration, "--out", "t.csv", "--resume"},
               folder.path());
  };
  ASSERT_EQ(
      run({"sweep", "push.lua", "--param", "push=1,2", "--duration", "0.5", "--out", "t.csv"}, folder.path()).code, 0);
  const std::string table = content(folder.path() + "/t.csv");
  const RunResult values = sweep("1,3", "0.5");
  EXPECT_EQ(values.code, 1);
  EXPECT_NE(values.err.find("t.csv: row 2 belongs to another sweep"), std::string::npos) << values.err;
  const RunResult duration = sweep("1,2,3", "0.6");
  EXPECT_EQ(duration.code, 1);
  EXPECT_NE(duration.err.find("row 2 gives another hash now, so the scene, the duration or the program has changed"),
            std::string::npos)
      << duration.err;
  EXPECT_EQ(content(folder.path() + "/t.csv"), table);
}

TEST(Sweep, CtrlCKeepsTheRows) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const std::vector<std::string> command{"sweep",      "push.lua", "--samples", "100000",
                                         "--duration", "0.5",      "--out",     "t.csv"};
  Process process(limber_command(command), folder.path());
  ASSERT_TRUE(process.wait_for("evaluation")) << process.err();  // the first line of progress
  process.signal(SIGINT);
  const RunResult result = process.finish();
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find("continue with the same command and --resume"), std::string::npos) << result.err;
  const std::vector<Row> table = rows(content(folder.path() + "/t.csv"));
  ASSERT_GT(table.size(), 1u);
  for (std::size_t i = 1; i < table.size(); i++) EXPECT_EQ(table[i][0], std::to_string(i - 1));
}

TEST(Sweep, FailuresAreRowsWithTheirReason) {
  const TempFolder folder;
  folder.file("fails.lua", R"(
params { { "x", 0, min = 0, max = 4 } }
sim:on_step(function() if params.x == 1 then error("one") end end)
result("root", function()
  if params.x == 2 then return 0 / 0 end
  if params.x == 3 then return nil end
  return params.x
end)
)");
  const RunResult result = run({"sweep", "fails.lua", "--param", "x=0:4:1", "--duration", "0.1"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const std::vector<Row> table = rows(result.out);
  ASSERT_EQ(table.size(), 6u);
  EXPECT_EQ(table[1][5], "");
  EXPECT_NE(table[2][5].find("fails.lua:3: one"), std::string::npos) << table[2][5];
  EXPECT_EQ(table[3][5], "result 'root' is nan");
  EXPECT_EQ(table[3][3], "");
  EXPECT_NE(result.out.find("the function returns a number, not nothing"), std::string::npos) << result.out;
  EXPECT_EQ(table[5][3], "4");
  EXPECT_NE(result.err.find("5 of 5 evaluations, 3 failed"), std::string::npos) << result.err;
}

TEST(Sweep, WrongInputIsExplained) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  folder.file("wrong.lua", "x = nothing\n");
  folder.file("plain.lua", "");
  const auto expect = [&](std::vector<std::string> args, int code, const char* message) {
    const RunResult result = run(std::move(args), folder.path());
    EXPECT_EQ(result.code, code) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  expect({"sweep", "push.lua", "--param", "pusch=0:1:0.5"}, 2,
         "--param pusch: the scene has no such parameter; did you mean 'push'?");
  expect({"sweep", "push.lua", "--param", "push=0:9:1"}, 2, "--param push: values must be within 0 .. 4");
  expect({"sweep", "push.lua", "--param", "push"}, 2, "write NAME=MIN:MAX:STEP");
  expect({"sweep", "push.lua"}, 2, "a grid needs the values of 'push'");
  expect({"sweep", "push.lua", "--resume"}, 2, "--resume continues the table of --out; name it");
  expect({"sweep", "plain.lua"}, 2, "the scene has no parameters; declare them with params");
  expect({"sweep", "wrong.lua", "--samples", "4"}, 1, "wrong.lua:1: there is no global 'nothing'");
  expect({"sweep", "no.lua", "--samples", "4"}, 1, "no.lua");
  expect({"sweep", "push.lua", "--samples", "4", "--duration", "0.1", "--out", "/dev/full", "--overwrite"}, 3,
         "/dev/full can't be written: No space left on device");
  expect({"evolve", "push.lua"}, 2, "name the result to search for: --maximize RESULT or --minimize RESULT");
  expect({"evolve", "push.lua", "--maximize", "distanze"}, 2, "did you mean 'distance'?");
  expect({"evolve", "push.lua", "--maximize", "distance", "--descriptor", "noise"}, 2, "the result has no range");
  expect({"evolve", "plain.lua", "--maximize", "x"}, 2, "the scene has no parameters");
  expect({"push.lua", "--fast", "--ticks", "1", "--param", "pusch=1"}, 1,
         "--param pusch: the scene has no such parameter; did you mean 'push'?");
  expect({"plain.lua", "--fast", "--ticks", "1", "--param", "a=1"}, 1, "the scene has no parameters");
  expect({"push.lua", "--fast", "--ticks", "1", "--param", "push"}, 2, "write NAME=VALUE, such as rate=0.5");
  expect({"plain.lua", "--fast", "--ticks", "1", "--out", "x.csv"}, 1, "the scene records no columns");
}

TEST(RunOutput, CsvHasARowPerSample) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const RunResult result = run({"push.lua", "--fast", "--duration", "1", "--out", "r.csv"}, folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<Row> table = rows(content(folder.path() + "/r.csv"));
  ASSERT_EQ(table.size(), 11u);  // at 0, 0.1 … 0.9 s
  EXPECT_EQ(table[0], (Row{"tick", "time", "x"}));
  for (std::size_t i = 1; i < table.size(); i++) {
    EXPECT_EQ(table[i][0], std::to_string(6 * (i - 1)));
    EXPECT_NEAR(std::stod(table[i][1]), 0.1 * static_cast<double>(i - 1), 1e-9);
    EXPECT_NEAR(std::stod(table[i][2]), 0.1 * static_cast<double>(i - 1), 1e-5);  // 1 N·s on 1 kg
  }
  const RunResult again = run({"push.lua", "--fast", "--duration", "1", "--out", "r.csv"}, folder.path());
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.err.find("already exists: choose another name"), std::string::npos) << again.err;
}

TEST(RunOutput, FolderDescribesTheRun) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const RunResult result = run({"push.lua", "--fast", "--duration", "1", "--out", "r", "--seed", "9", "--param",
                                "push=2", "--param", "way=back", "--hash"},
                               folder.path());
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(content(folder.path() + "/r/metadata.json"));
  EXPECT_EQ(json.at("seed"), 9);
  EXPECT_EQ(json.at("tick"), 60);
  EXPECT_EQ(json.at("complete"), true);
  EXPECT_EQ(json.at("parameters"), nlohmann::json::parse(R"({"push": 2.0, "mass": 1.0, "way": "back"})"));
  EXPECT_NEAR(json.at("results").at("distance").get<double>(), -2, 1e-5);
  EXPECT_NE(result.out.find("hash " + json.at("state_hash").get<std::string>()), std::string::npos) << result.out;
  EXPECT_EQ(rows(content(folder.path() + "/r/rows.csv")).size(), 11u);
}

TEST(RunOutput, DoesNotChangeTheMotion) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  const RunResult with = run({"push.lua", "--fast", "--duration", "1", "--hash", "--out", "r.jsonl"}, folder.path());
  const RunResult without = run({"push.lua", "--fast", "--duration", "1", "--hash"}, folder.path());
  EXPECT_EQ(with.out, without.out);
  std::istringstream lines(content(folder.path() + "/r.jsonl"));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, R"({"tick":0,"time":0,"x":0})");
}

}  // namespace
}  // namespace limber::app::test
