// The examples in docs/reference/osc.md, docs/howto/presets.md and docs/examples work: each message is sent to a scene
// that has the named objects.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include "app/commands/describe.h"
#include "app/commands/send_arguments.h"
#include "app/program.h"
#include "engine/engine.h"

namespace limber::app::test {
namespace {

constexpr const char* kPageScene = R"(
params {
  { "speed", 0.12, min = 0, max = 1 }, { "depth", 0.6, min = 0, max = 1.2 }, { "lag", 0.6, min = 0, max = 3.14 },
}
local arm = sim:load_urdf("urdf/arm6.urdf", { name = "arm1" })
arm:add_behavior("random_force", "wind", { parts = "tip" })
arm:copy("arm2", { position = vec3(2, 0, 0) })
sim:add_group_behavior("cohesion", "swarm", { bodies = "arm*", parts = "tip" })
osc:on("/sway", function() end)
)";

std::string text_of(const std::string& file) {
  std::ifstream in(LIMBER_SOURCE_DIR "/docs/" + file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_FALSE(text.empty()) << file;
  return text;
}

// an engine in this process; messages take effect in the next tick
class LocalEngine {
 public:
  LocalEngine() {
    engine::EngineOptions options;
    options.scene = folder_.file("scene.lua", kPageScene);
    options.scene_options.data_dir = LIMBER_SOURCE_DIR;
    options.fast = true;
    link_.on_scene_request = [](const Message&, const CommandOrigin&) {
    };  // scenes and takes are covered by another test
    link_.on_midi_request = link_.on_scene_request;
    link_.on_osc_request = [](const Message&, const CommandOrigin&) { return Result<void>(); };
    engine_ = std::make_unique<engine::Engine>(link_, options);
    const Result<void> started = engine_->start();
    EXPECT_TRUE(started.ok()) << started.error();
    outbox();
  }

  /// Sends the message and expects that it is neither rejected nor unknown.
  void expect_accepted(const Message& message) {
    link_.command_queue.push({{message}, {CommandSource::osc, 0x7f000001, 4000}});
    engine_->tick();
    for (const engine::Outgoing& out : outbox())
      EXPECT_NE(out.destination, engine::Outgoing::Destination::error)
          << engine::message_text(message) << ": " << engine::message_text(out.message);
    EXPECT_EQ(link_.counters.clamped.load(), 0u) << engine::message_text(message) << " is out of range";
  }

 private:
  std::vector<engine::Outgoing> outbox() {
    std::vector<engine::Outgoing> out;
    link_.output_queue.drain(out);
    return out;
  }

  TempFolder folder_;
  engine::EngineLink link_;
  std::unique_ptr<engine::Engine> engine_;
};

// splits words like a shell; two spaces end the command on the page, an explanation follows
std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  char quote = 0;
  for (std::size_t i = 0; i <= line.size(); i++) {
    const char c = i < line.size() ? line[i] : ' ';
    if (quote != 0 ? c == quote : c == '"' || c == '\'') {
      quote = quote != 0 ? 0 : c;
    } else if (quote != 0 || c != ' ') {
      word += c;
    } else {
      if (!word.empty()) words.push_back(std::exchange(word, ""));
      if (i + 1 < line.size() && line[i + 1] == ' ') break;
    }
  }
  return words;
}

Message message_of(const std::vector<std::string>& words) {
  Message message{words.at(0), {}};
  for (std::size_t i = 1; i < words.size(); i++) message.args.push_back(parse_arg(words[i]));
  return message;
}

TEST(DocsOsc, ExamplesOfThePagesAreAccepted) {
  for (const auto& [page_name, min_count] : {std::pair("reference/osc.md", 25u), std::pair("howto/presets.md", 12u),
                                             std::pair("howto/takes.md", 4u), std::pair("howto/recovery.md", 2u)}) {
    LocalEngine engine;
    std::istringstream page(text_of(page_name));
    std::size_t sent = 0;
    for (std::string line; std::getline(page, line);) {
      if (!line.starts_with("    ")) continue;
      std::vector<std::string> words = shell_words(line.substr(4));
      if (words.size() > 2 && words[0] == "limber" && words[1] == "send") words.erase(words.begin(), words.begin() + 2);
      if (words.empty() || !words[0].starts_with("/")) continue;
      SCOPED_TRACE(line);
      engine.expect_accepted(message_of(words));
      sent++;
    }
    EXPECT_GE(sent, min_count) << page_name;
  }
}

TEST(DocsOsc, ReferenceIsUpToDate) {
  const std::string page = text_of("reference/osc_addresses.md");
  const std::string marker = "<!-- reference -->\n";
  const std::size_t at = page.find(marker);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(page.substr(at + marker.size()), describe_page())
      << "update it: insert the output of `build/limber describe --markdown` after the mark";
}

TEST(DocsOsc, OpenStageControlLayoutIsAccepted) {
  LocalEngine engine;
  const auto layout = nlohmann::json::parse(text_of("examples/open-stage-control.json"));
  std::size_t sent = 0;
  for (const auto& widget : layout["content"]["widgets"]) {
    SCOPED_TRACE(widget["id"].get<std::string>());
    EXPECT_EQ(widget["target"], nlohmann::json::array({"127.0.0.1:9003"}));
    Message message{widget["address"], {}};
    const auto add = [&](const nlohmann::json& value) {
      if (value.is_array()) {
        for (const auto& v : value) message.args.push_back(v.is_string() ? parse_arg(v) : Arg::of(v.get<double>()));
      } else if (value.is_number()) {
        message.args.push_back(Arg::of(value.get<double>()));
      }
    };
    add(widget["preArgs"]);
    add(widget.contains("default") ? widget["default"] : widget["on"]);
    EXPECT_EQ(widget["typeTags"].get<std::string>().size(), message.args.size());
    engine.expect_accepted(message);
    sent++;
  }
  EXPECT_EQ(sent, layout["content"]["widgets"].size());
  EXPECT_GE(sent, 10u);
}

TEST(DocsOsc, SuperColliderMessagesAreAccepted) {
  LocalEngine engine;
  const std::string text = text_of("examples/limber.scd");
  const std::regex message(R"re((?:sendMsg\(|\[)("/[^)\]]*)[)\]])re");
  std::size_t sent = 0;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), message); it != std::sregex_iterator(); ++it) {
    std::string list = (*it)[1];
    std::ranges::replace(list, ',', ' ');
    list = std::regex_replace(list, std::regex(" +"), " ");
    const Message m = message_of(shell_words(list));
    // the network answers this itself
    if (m.address == "/subscribe") continue;
    engine.expect_accepted(m);
    sent++;
  }
  EXPECT_GE(sent, 12u);
}

// the program with that scene; `in`: its OSC input port
struct PagePlayer {
  explicit PagePlayer(const std::string& out = "off")
      : running(limber_command({folder.file("scripts/scene.lua", kPageScene), "--osc-in", "127.0.0.1:0", "--osc-out",
                                out, "--query", "off"})) {
    EXPECT_TRUE(running.wait_for("playing headless")) << running.err();
    in = running.text_after("OSC in 127.0.0.1:");
  }
  TempFolder folder;
  Process running;
  std::string in;
};

TEST(DocsOsc, PythonExampleSendsAndReceives) {
  PagePlayer player;
  const std::string file = LIMBER_SOURCE_DIR "/docs/examples/limber.py";
  RunResult result;
  int frames = 0;
  // on a busy machine no frame may arrive in half a second
  for (const char* seconds : {"0.5", "5", "50"}) {
    result = Process({"python3", "-B", file, "--port", player.in, "--seconds", seconds}).finish();
    EXPECT_EQ(result.code, 0) << result.err;
    const std::size_t at = result.out.find("frames: ");
    ASSERT_NE(at, std::string::npos) << result.out;
    frames = std::stoi(result.out.substr(at + 8));
    if (frames > 0) break;
  }
  EXPECT_GT(frames, 0);
  EXPECT_NE(result.out.find("gravity is [0.0, 0.0, -9.8"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("bodies: arm1 arm2\n"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("/physics/"), std::string::npos) << "no message was rejected: " << result.out;
}

TEST(DocsOsc, PdPatchSendsAndReceives) {
  PagePlayer player;
  const std::string patch = LIMBER_SOURCE_DIR "/docs/examples/limber.pd";
  Process pd({"pd", "-nogui", "-nosound", "-noprefs", "-stderr", "-open", patch, "-send",
              fmt::format("ports {} {}", player.in, 9), "-send", "gravity -3", "-send", "target 0.5", "-send", "wind 4",
              "-send", "ask bang"});
  EXPECT_TRUE(pd.wait_for("gravity 0 0 -3")) << pd.err();
  EXPECT_EQ(pd.err().find("/error"), std::string::npos) << pd.err();
}

TEST(DocsOsc, PdPresetPatchStoresRecallsAndMorphs) {
  PagePlayer player;
  const std::string patch = LIMBER_SOURCE_DIR "/docs/examples/presets.pd";
  // runs a new Pure Data each time; it has finished when the names are printed
  const auto play = [&](const std::vector<std::string>& sends, const std::string& names) {
    std::vector<std::string> words{"pd",    "-nogui", "-nosound", "-noprefs",          "-stderr",
                                   "-open", patch,    "-send",    "ports " + player.in};
    for (const std::string& send : sends) words.insert(words.end(), {"-send", send});
    words.insert(words.end(), {"-send", "ask bang"});
    Process pd(words);
    EXPECT_TRUE(pd.wait_for("presets " + names + "\n")) << pd.err();
    EXPECT_EQ(pd.err().find("error"), std::string::npos) << pd.err();
  };
  const auto ask = [&](const std::string& path) {
    return run({"send", "/get", path, "--to", "127.0.0.1:" + player.in, "--wait", "30"}).out;
  };
  const auto set_speed = [&](const char* speed) {
    EXPECT_EQ(run({"send", "/scene/speed", speed, "--to", "127.0.0.1:" + player.in, "--wait", "60"}).code, 0);
  };
  play({"store symbol dusk"}, "dusk");
  set_speed("0.52");
  play({"store symbol dawn"}, "dusk dawn");
  set_speed("0.9");
  play({"morph 0.25"}, "dusk dawn");
  EXPECT_EQ(ask("/scene/speed"), "/scene/speed 0.22\n") << "a quarter of the way from 0.12 to 0.52";
  play({"between 1.5"}, "dusk dawn");
  EXPECT_EQ(ask("/scene/speed"), "/scene/speed 0.32\n");
  play({"recall list dawn 0.1"}, "dusk dawn");
  for (int i = 0; i < 1000 && ask("/preset/progress") != "/preset/progress 1\n"; i++) continue;
  EXPECT_EQ(ask("/scene/speed"), "/scene/speed 0.52\n");
  play({"recall list dusk 0"}, "dusk dawn");
  EXPECT_EQ(ask("/scene/speed"), "/scene/speed 0.12\n");
}

}  // namespace
}  // namespace limber::app::test
