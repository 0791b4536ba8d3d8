// Every refusal of the program: tests/errors.tsv lists its input, exact text, exit code and cure; this walks it, and
// looks through the sources for a refusal that is not in it.
#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>

#include "app/program.h"
#include "app/taken_port.h"

namespace limber::app_test {
namespace {

struct Refusal {
  int line = 0;
  std::string input;
  int code = 0;
  std::string text;
  std::string cure;
};

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

void replace_all(std::string& text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

std::vector<Refusal> refusals() {
  std::istringstream in(read_file(LIMBER_SOURCE_DIR "/tests/errors.tsv"));
  std::vector<Refusal> list;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    number++;
    if (line.empty() || line[0] == '#') continue;
    Refusal r;
    r.line = number;
    std::istringstream cells(line);
    std::string code;
    std::getline(cells, r.input, '\t');
    std::getline(cells, code, '\t');
    std::getline(cells, r.text, '\t');
    std::getline(cells, r.cure, '\t');
    r.code = std::atoi(code.c_str());
    replace_all(r.text, "\\n", "\n");
    list.push_back(r);
  }
  return list;
}

// the files that inputs name as <dir>/…
void write_inputs(const Folder& folder) {
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
}

// arguments parted by blanks, '…' keeping some together
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

Ran run_input(const std::string& input) {
  // "in FOLDER ARGUMENTS" is called there
  if (input.starts_with("in ")) {
    const std::size_t blank = input.find(' ', 3);
    return run(quoted_words(input.substr(blank + 1)), input.substr(3, blank - 3));
  }
  // "^C when TEXT: ARGUMENTS" is somebody's Ctrl+C, twice, once that text was said
  if (!input.starts_with("^C when ")) return run(quoted_words(input));
  const std::size_t colon = input.find(": ");
  Running running(limber(quoted_words(input.substr(colon + 2))));
  running.wait_for(input.substr(8, colon - 8));
  running.signal(SIGINT);
  if (running.wait_for("\nlimber: ended ")) return running.finish();
  running.signal(SIGINT);
  return running.finish();
}

TEST(Errors, EachRefusalIsAsTheTableSays) {
  const Folder folder;
  write_inputs(folder);
  const TakenPort taken(SOCK_DGRAM);
  const TakenPort taken_tcp(SOCK_STREAM);
  const std::vector<Refusal> list = refusals();
  EXPECT_GT(list.size(), 20U);
  for (const Refusal& r : list) {
    std::string input = r.input;
    std::string text = r.text;
    for (std::string* s : {&input, &text}) {
      replace_all(*s, "<dir>", folder.path());
      replace_all(*s, "<port>", taken.number());
      replace_all(*s, "<tcp>", taken_tcp.number());
      replace_all(*s, "<source>", LIMBER_SOURCE_DIR);
    }
    const Ran ran = run_input(input);
    EXPECT_EQ(ran.code, r.code) << "errors.tsv:" << r.line << ": " << input << "\n" << ran.err;
    // inspect's begin with the file, as a compiler's do
    const std::string said = "\n" + ran.err;
    const bool as_listed = said.find("\nlimber: " + text + "\n") != std::string::npos ||
                           (input.starts_with("inspect") && said.find("\n" + text + "\n") != std::string::npos);
    EXPECT_TRUE(as_listed) << "errors.tsv:" << r.line << ": " << input << "\nexpected: " << text
                           << "\nsaid: " << ran.err;
    EXPECT_NE(r.text.find(r.cure), std::string::npos) << "errors.tsv:" << r.line << ": its text does not hold the cure";
    EXPECT_FALSE(r.cure.empty()) << "errors.tsv:" << r.line;
  }
}

// the constant pieces of the texts that a source file refuses with
std::vector<std::string> refusal_texts(const std::string& source) {
  std::vector<std::string> texts;
  // a text may hold a semicolon: a statement ends with the line
  static const std::regex refusal(R"re((Error\{|fail\(k|leave\(|return fmt::format\(|return ")[\s\S]*?;\n)re");
  static const std::regex literal(R"re("((?:[^"\\]|\\.)*)")re");
  for (std::sregex_iterator at(source.begin(), source.end(), refusal), end; at != end; ++at) {
    const std::string statement = at->str();
    for (std::sregex_iterator l(statement.begin(), statement.end(), literal), none; l != none; ++l) {
      std::string text = (*l)[1];
      replace_all(text, "limber: ", "");
      replace_all(text, "\\n", "");
      // longest piece between two placeholders
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

TEST(Errors, NoRefusalIsMissingInTheTable) {
  std::string all;
  for (const Refusal& r : refusals()) all += r.text + "\n";
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/src/app")) {
    if (entry.path().extension() != ".cpp") continue;
    // what these write is their answer, what they refuse with comes from others; these two need a program that runs
    // (console_test.cpp, monitor_test.cpp), these a display and a machine without ffmpeg (window_test.cpp,
    // render_test.cpp), this one an output that fails (output_test.cpp), these a folder of units (service_test.cpp),
    // and show a machine without memory (tests/environment)
    const std::string name = entry.path().stem().string();
    if (name == "console" || name == "monitor" || name.starts_with("describe") || name == "doctor" ||
        name == "exit_code" || name == "window" || name == "film_file" || name == "inspect" || name == "man_page" ||
        name.starts_with("service") || name == "show" || name.starts_with("bench_") || name.starts_with("completion_"))
      continue;
    for (const std::string& text : refusal_texts(read_file(entry.path()))) {
      found++;
      EXPECT_NE(all.find(text), std::string::npos)
          << entry.path().filename().string() << " refuses with \"" << text << "\", which is not in tests/errors.tsv";
    }
  }
  EXPECT_GT(found, 8U) << "the search finds nothing any more";
}

TEST(Errors, APlantedRefusalIsFound) {
  EXPECT_EQ(refusal_texts(R"(if (x) return fail(kInput, fmt::format("the {} is far; too blue for {}", a, b));
)"),
            std::vector<std::string>{" is far; too blue for "});
  EXPECT_TRUE(refusal_texts(R"(finding("ok", "limber", "everything is all right");
)")
                  .empty());
}

}  // namespace
}  // namespace limber::app_test
