// Every error of the program: tests/errors.tsv lists its input, exact text, exit code and fix. This test runs each line
// and searches the sources for errors that are not in the table.
#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>

#include "app/program.h"
#include "app/taken_port.h"
#include "support/skip.h"

namespace limber::app::test {
namespace {

struct ErrorCase {
  int line = 0;
  std::string input;
  int code = 0;
  std::string text;
  std::string fix;
};

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::vector<ErrorCase> error_cases() {
  std::istringstream in(read_file(LIMBER_SOURCE_DIR "/tests/errors.tsv"));
  std::vector<ErrorCase> list;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    number++;
    if (line.empty() || line[0] == '#') continue;
    ErrorCase r;
    r.line = number;
    std::istringstream cells(line);
    std::string code;
    std::getline(cells, r.input, '\t');
    std::getline(cells, code, '\t');
    std::getline(cells, r.text, '\t');
    std::getline(cells, r.fix, '\t');
    r.code = std::atoi(code.c_str());
    replace_all(r.text, "\\n", "\n");
    list.push_back(r);
  }
  return list;
}

// creates the files that the inputs refer to as <dir>/…
void write_inputs(const TempFolder& folder) {
  folder.file("good.lua", "sim:add_body('arm'):add_part('tip', sim:add_sphere_shape('ball', 0.1))\n");
  folder.file("syntax.lua", "local x =\n");
  folder.file("typo.lua", "sim.gravty = vec3(0, 0, 0)\n");
  folder.file("erring.lua", "sim:on_step(function() error('oh') end)\n");
  folder.file("endless.lua", "while true do end\n");
  folder.file("heavy.lua",
              "sim.solver, sim.substeps, sim.solver_iterations = 'iterative', 1000, 10000\n"
              "local ball = sim:add_sphere_shape('ball', 0.1)\n"
              "local chain = sim:add_body('chain')\n"
              "local before = chain:add_part('0', ball, { mass = 0 })\n"
              "for i = 1, 300 do\n"
              "  local part = chain:add_part(tostring(i), ball, { position = vec3(i, 0, 0) })\n"
              "  chain:add_joint(tostring(i), before, part, { position = vec3(i - 0.5, 0, 0), axis = vec3(0, 1, 0) })\n"
              "  before = part\n"
              "end\n"
              "sim:on_step(function() warn('round and round') end)\n");
  folder.file("show/scripts/scene.lua", "");
  folder.file("there.csv", "");
  EXPECT_EQ(run({folder.path() + "/good.lua", "--fast", "--ticks", "6", "--record", folder.path() + "/six.take"}).code,
            0);
  folder.file("broken.urdf", "<robot name='r'><link name='a'>");
  folder.file("empty.xml", "<mujoco/>");
  folder.file("notes.txt", "");
  folder.file("robot.urdf.xacro", "");
  folder.file("ball.xml",
              "<mujoco>\n<worldbody><body name='ball'><freejoint/><geom size='1'/></body></worldbody></mujoco>");
}

// splits arguments at spaces, '…' groups words
std::vector<std::string> quoted_words(const std::string& input) {
  std::vector<std::string> words;
  bool inside = false;
  bool open = false;
  for (const char c : input) {
    if (c == '\'') {
      inside = !inside;
      if (!open) words.emplace_back();
      open = true;
    } else if (c == ' ' && !inside) {
      open = false;
    } else {
      if (!open) words.emplace_back();
      open = true;
      words.back() += c;
    }
  }
  return words;
}

RunResult run_input(const std::string& input) {
  // "in FOLDER ARGUMENTS" runs in that folder
  if (input.starts_with("in ")) {
    const std::size_t blank = input.find(' ', 3);
    return run(quoted_words(input.substr(blank + 1)), input.substr(3, blank - 3));
  }
  // "^C when TEXT: ARGUMENTS" presses Ctrl+C twice after that text was printed
  if (!input.starts_with("^C when ")) return run(quoted_words(input));
  const std::size_t colon = input.find(": ");
  Process running(limber_command(quoted_words(input.substr(colon + 2))));
  running.wait_for(input.substr(8, colon - 8));
  running.signal(SIGINT);
  if (running.wait_for("\nlimber: interrupted ")) return running.finish();
  running.signal(SIGINT);
  return running.finish();
}

TEST(Errors, MatchTheTable) {
  const TempFolder folder;
  write_inputs(folder);
  const PortInUse port_in_use(SOCK_DGRAM);
  const PortInUse taken_tcp(SOCK_STREAM);
  const std::vector<ErrorCase> list = error_cases();
  EXPECT_GT(list.size(), 20U);
  for (const ErrorCase& r : list) {
    std::string input = r.input;
    std::string text = r.text;
    for (std::string* s : {&input, &text}) {
      replace_all(*s, "<dir>", folder.path());
      replace_all(*s, "<port>", port_in_use.port());
      replace_all(*s, "<tcp>", taken_tcp.port());
      replace_all(*s, "<source>", LIMBER_SOURCE_DIR);
    }
    const RunResult result = run_input(input);
    EXPECT_EQ(result.code, r.code) << "errors.tsv:" << r.line << ": " << input << "\n" << result.err;
    // errors of `inspect` begin with the file name, like a compiler's
    const std::string output = "\n" + result.err;
    const bool as_listed = output.find("\nlimber: " + text + "\n") != std::string::npos ||
                           (input.starts_with("inspect") && output.find("\n" + text + "\n") != std::string::npos);
    EXPECT_TRUE(as_listed) << "errors.tsv:" << r.line << ": " << input << "\nexpected: " << text
                           << "\ngot: " << result.err;
    EXPECT_NE(r.text.find(r.fix), std::string::npos)
        << "errors.tsv:" << r.line << ": its text does not contain the fix";
    EXPECT_FALSE(r.fix.empty()) << "errors.tsv:" << r.line;
  }
}

// the constant parts of a source file's error messages
std::vector<std::string> error_literals(const std::string& source) {
  std::vector<std::string> texts;
  // a text may contain a semicolon: a statement ends at the end of a line
  static const std::regex refusal(R"re((Error\{|fail\(k|leave\(|return fmt::format\(|return ")[\s\S]*?;\n)re");
  static const std::regex literal(R"re("((?:[^"\\]|\\.)*)")re");
  for (std::sregex_iterator at(source.begin(), source.end(), refusal), end; at != end; ++at) {
    const std::string statement = at->str();
    for (std::sregex_iterator l(statement.begin(), statement.end(), literal), none; l != none; ++l) {
      std::string text = (*l)[1];
      replace_all(text, "limber: ", "");
      replace_all(text, "\\n", "");
      // longest part between two placeholders
      std::string longest;
      for (std::size_t from = 0; from <= text.size();) {
        const std::size_t open = std::min(text.find('{', from), text.size());
        if (open - from > longest.size()) longest = text.substr(from, open - from);
        from = text.find('}', open) == std::string::npos ? text.size() + 1 : text.find('}', open) + 1;
      }
      if (longest.size() >= 8) texts.push_back(longest);
    }
  }
  return texts;
}

TEST(Errors, TableIsComplete) {
  std::string all;
  for (const ErrorCase& r : error_cases()) all += r.text + "\n";
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(LIMBER_SOURCE_DIR "/src/app")) {
    if (entry.path().extension() != ".cpp") continue;
    // excluded: files with results only, or with errors of other files; console and monitor need a running
    // program (console_test.cpp, monitor_test.cpp); window and film_file need a display or a machine without ffmpeg
    // (window_test.cpp, render_test.cpp); exit_code a failing output (output_test.cpp); service a folder of units
    // (service_test.cpp); docs an installation (docs_command_test.cpp); model_scene a machine without folders
    // (viewer_test.cpp); engine_thread a machine without memory
    // (tests/environment); experiments and run_file many scenes (sweep_test.cpp); breed a display (breed_test.cpp)
    const std::string name = entry.path().stem().string();
    if (name == "console" || name == "monitor" || name.starts_with("describe") || name == "doctor" ||
        name == "exit_code" || name == "window" || name == "film_file" || name == "inspect" || name == "man_page" ||
        name == "command_page" || name == "docs" || name.starts_with("service") || name == "engine_thread" ||
        name == "model_scene" || name == "run_file" || name.starts_with("completion_") ||
        entry.path().parent_path().filename() == "experiments" || entry.path().parent_path().filename() == "breed")
      continue;
    for (const std::string& text : error_literals(read_file(entry.path()))) {
      found++;
      EXPECT_NE(all.find(text), std::string::npos)
          << entry.path().filename().string() << " has the error \"" << text << "\", which is not in tests/errors.tsv";
    }
  }
  EXPECT_GT(found, 8U) << "the search pattern is out of date";
}

TEST(Errors, SearchFindsAnError) {
  EXPECT_EQ(error_literals(R"(if (x) return fail(kInput, fmt::format("the {} is far; too blue for {}", a, b));
)"),
            std::vector<std::string>{" is far; too blue for "});
  EXPECT_TRUE(error_literals(R"(finding("ok", "limber", "everything is all right");
)")
                  .empty());
}

}  // namespace
}  // namespace limber::app::test
