// The reference printed by `limber describe`: the golden file of all addresses, a scene's own addresses, and JSON.
#include "app/commands/describe.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "app/program.h"
#include "engine/engine.h"

namespace limber::app::test {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> columns(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t start = 0;
  while (true) {
    const std::size_t tab = line.find('\t', start);
    cells.push_back(line.substr(start, tab - start));
    if (tab == std::string::npos) return cells;
    start = tab + 1;
  }
}

TEST(Describe, MatchesTheGoldenFile) {
  std::ifstream in(LIMBER_SOURCE_DIR "/tests/golden/addresses.txt");
  const std::vector<std::string> golden = lines_of({std::istreambuf_iterator<char>(in), {}});
  const std::vector<std::string> now = lines_of(describe_classes());
  std::string changes;
  for (const std::string& line : golden) {
    if (std::find(now.begin(), now.end(), line) == now.end()) changes += "- " + line + "\n";
  }
  for (const std::string& line : now) {
    if (std::find(golden.begin(), golden.end(), line) == golden.end()) changes += "+ " + line + "\n";
  }
  EXPECT_EQ(changes, "") << "patches and presets depend on addresses. If the change is intended, update the file:\n"
                            "    build/limber describe > tests/golden/addresses.txt";
  EXPECT_EQ(golden, now) << "the same lines in another order";
}

TEST(Describe, EachLineHasEveryColumn) {
  const std::vector<std::string> lines = lines_of(describe_classes());
  EXPECT_EQ(lines[0], "address\tlegacy address\tkind\ttype\tunit\trange\tdefault\tmeaning");
  for (const std::string& line : lines) EXPECT_EQ(columns(line).size(), 8U) << line;
  const auto mass = std::find_if(lines.begin(), lines.end(), [](const std::string& l) {
    return l.starts_with("/physics/body/<body>/part/<part>/mass\t");
  });
  ASSERT_NE(mass, lines.end());
  const std::vector<std::string> cells = columns(*mass);
  EXPECT_EQ(cells[1], "/physics/part/mass");
  EXPECT_EQ(cells[2], "property");
  EXPECT_EQ(cells[3], "number");
  EXPECT_EQ(cells[4], "kg");
  EXPECT_EQ(cells[5], "0.001 .. 1000000");
  EXPECT_EQ(cells[6], "1");
}

TEST(Describe, ProgramPrintsTheSame) {
  const RunResult result = run({"describe"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, describe_classes());
  EXPECT_EQ(result.err, "");
}

TEST(Describe, ListsAddressesOfAScene) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", R"(
print("this is not the answer")
sim:add_body("left arm"):add_part("p/1", sim:add_sphere_shape("ball", 0.1))
params { { "wind", 2, min = 0, max = 10, unit = "N", doc = "How hard it blows." } }
)");
  const RunResult result = run({"describe", scene});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find("\n/physics/body/left%20arm/part/p%2F1/friction\t/physics/part/friction\t"),
            std::string::npos);
  EXPECT_NE(result.out.find("\n/scene/wind\t\tproperty\tnumber\tN\t0 .. 10\t2\tHow hard it blows.\n"),
            std::string::npos);
  EXPECT_EQ(result.out.find("not the answer"), std::string::npos);
  EXPECT_NE(result.err.find("not the answer"), std::string::npos);
}

TEST(Describe, PrintsJson) {
  const RunResult result = run({"describe", "--json"});
  EXPECT_EQ(result.code, 0);
  const auto json = nlohmann::json::parse(result.out);
  std::size_t found = 0;
  for (const auto& entry : json) {
    EXPECT_TRUE(entry.contains("path") && entry.contains("kind") && entry.contains("doc"));
    if (entry["path"] != "/physics/body/<body>/motor/<motor>/mode") continue;
    found++;
    EXPECT_EQ(entry["choices"], (std::vector<std::string>{"off", "spin", "servo", "spring", "torque"}));
    EXPECT_EQ(entry["seed"], "/physics/motor/mode");
    EXPECT_EQ(entry["default"], std::vector<double>{2});
  }
  EXPECT_EQ(found, 1U);
  EXPECT_EQ(json.size() + 1, lines_of(describe_classes()).size());
}

TEST(Describe, ParametersHaveStepsAndRangesPerAxis) {
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", R"(
params {
  { "wind", 2, min = 0, max = 10, step = 0.5 },
  { "where", vec3(1, 1, 1), min = vec3(0, 0, -1), max = vec3(1, 2, 3) },
}
)");
  const RunResult text = run({"describe", scene});
  EXPECT_NE(text.out.find("\n/scene/where\t\tproperty\tvec3\t\t0 0 -1 .. 1 2 3\t1 1 1\t\n"), std::string::npos);
  const auto json = nlohmann::json::parse(run({"describe", "--json", scene}).out);
  std::size_t found = 0;
  for (const auto& entry : json) {
    if (entry["path"] == "/scene/wind") {
      found++;
      EXPECT_EQ(entry["step"], 0.5);
      EXPECT_EQ(entry["max"], 10);
    } else if (entry["path"] == "/scene/where") {
      found++;
      EXPECT_FALSE(entry.contains("step"));
      EXPECT_EQ(entry["min"], (std::vector<double>{0, 0, -1}));
      EXPECT_EQ(entry["max"], (std::vector<double>{1, 2, 3}));
    } else {
      EXPECT_FALSE(entry.contains("step")) << entry["path"];
    }
  }
  EXPECT_EQ(found, 2U);
}

// docs/reference/osc_addresses.md must name all messages
TEST(Describe, OscReferenceNamesEveryMessage) {
  std::ifstream in(LIMBER_SOURCE_DIR "/docs/reference/osc_addresses.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  ASSERT_FALSE(page.empty());
  std::vector<std::string> known;
  for (const std::string& line : lines_of(describe_classes())) {
    const std::vector<std::string> cells = columns(line);
    const std::string& address = cells[2] == "message" ? cells[0] : cells[1];
    if (!address.starts_with("/")) continue;
    known.push_back(address);
    EXPECT_NE(page.find("`" + address + "`"), std::string::npos)
        << "docs/reference/osc_addresses.md does not name " << address;
  }
  // and every address in the first column of a table must exist
  for (const std::string& line : lines_of(page)) {
    if (!line.starts_with("| `/physics/") || line.find('<') != std::string::npos) continue;
    const std::string address = line.substr(3, line.find('`', 3) - 3);
    EXPECT_NE(std::find(known.begin(), known.end(), address), known.end()) << address << " does not exist";
  }
}

}  // namespace
}  // namespace limber::app::test
