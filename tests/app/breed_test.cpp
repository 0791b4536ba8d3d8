// limber breed: its processes, its presets, and the whole program on a display.
#include <csignal>
#include <string>
#include <vector>

#include "app/breed/breed_session.h"
#include "app/breed/variation_process.h"
#include "app/breed/variation_worker.h"
#include "app/display.h"
#include "base/system/child_process.h"
#include "base/system/clock.h"
#include "base/system/file.h"
#include "engine/presets/text.h"

namespace limber::app::test {
namespace {

using experiments::Axis;
using experiments::Breeding;
using panel::BreedAction;
using Kind = BreedAction::Kind;

/// A still ball beside the middle.
constexpr const char* kBall = R"(
params {
  { "place", 0, min = -2, max = 2, rerun = true },
  { "size", "small", choices = { "small", "large" }, rerun = true },
}
sim.gravity = vec3()
visuals.camera:look_at(vec3(0, -6, 1), vec3(0, 0, 1))
local radius = params.size == "small" and 0.3 or 0.9
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", radius), { position = vec3(params.place, 0, 1) })
)";

std::vector<std::string> variation_command() {
  return {LIMBER_PROGRAM, std::string(kVariationArgument), "auto", "low"};
}

/// As in the program, a write to a process that has ended is only an error.
class PipeSignalIgnored {
 public:
  PipeSignalIgnored() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~PipeSignalIgnored() { (void)std::signal(SIGPIPE, before_); }
  PipeSignalIgnored(const PipeSignalIgnored&) = delete;
  PipeSignalIgnored& operator=(const PipeSignalIgnored&) = delete;

 private:
  void (*before_)(int);
};

/// Waits for an image of the run; an empty one if the process has failed for good.
render::Pixels image_of(VariationProcess& process, bool paused = false) {
  ImageRequest request;
  request.width = 64;
  request.height = 36;
  request.paused = paused;
  while (true) {
    process.request(request, system::clock_seconds());
    if (process.descriptor() < 0) return {};
    if (process.read()) return process.image();
    if (!process.error().empty()) return {};
  }
}

TEST(Breed, AProcessPlaysAVariation) {
  const TempFolder folder;
  VariationProcess process(variation_command(), {folder.file("ball.lua", kBall), 0, {"place", "size"}});
  process.play({1, 1, {-1, 0}});
  const render::Pixels left = image_of(process);
  ASSERT_EQ(left.width, 64) << process.error();
  ASSERT_EQ(left.bytes.size(), 64u * 36 * 4);
  process.play({2, 1, {1, 0}});
  const render::Pixels right = image_of(process);
  EXPECT_NE(right.bytes, left.bytes);
  process.play({3, 1, {-1, 0}});
  EXPECT_EQ(image_of(process).bytes, left.bytes);
  process.play({4, 1, {-1, 1}});
  EXPECT_NE(image_of(process).bytes, left.bytes);
  EXPECT_EQ(process.error(), "");
}

TEST(Breed, AnImageOfTheRunBeforeIsSkipped) {
  const TempFolder folder;
  VariationProcess process(variation_command(), {folder.file("ball.lua", kBall), 0, {"place", "size"}});
  process.play({1, 1, {1, 0}});
  const render::Pixels right = image_of(process);
  process.play({2, 1, {-1, 0}});
  EXPECT_NE(image_of(process).bytes, right.bytes);
  ImageRequest request;
  request.width = right.width;
  request.height = right.height;
  process.request(request, system::clock_seconds());
  process.play({3, 1, {1, 0}});
  EXPECT_EQ(image_of(process).bytes, right.bytes);
}

TEST(Breed, AProcessThatDiesIsStartedAgain) {
  const PipeSignalIgnored ignored;
  const TempFolder folder;
  const std::string marker = folder.path() + "/died";
  // dies when it is started for the first time
  VariationProcess process({"sh", "-c",
                            fmt::format("[ -e {0} ] || {{ touch {0}; exit 1; }}; exec {1} {2} auto low", marker,
                                        LIMBER_PROGRAM, kVariationArgument)},
                           {folder.file("ball.lua", kBall), 0, {"place", "size"}});
  process.play({1, 1, {0, 0}});
  while (!std::filesystem::exists(marker) || process.descriptor() >= 0) {
    ImageRequest request;
    request.width = request.height = 8;
    process.request(request, 0);
    (void)process.read();
    if (!process.image().bytes.empty()) break;
  }
  EXPECT_EQ(image_of(process).width, 64) << process.error();
}

TEST(Breed, ReportsWhatDoesNotPlay) {
  const PipeSignalIgnored ignored;
  const TempFolder folder;
  VariationProcess fault(variation_command(), {folder.file("fault.lua", "nonsense()"), 0, {}});
  fault.play({1, 1, {}});
  EXPECT_TRUE(image_of(fault).bytes.empty());
  EXPECT_NE(fault.error().find("nonsense"), std::string::npos) << fault.error();

  VariationProcess dies({"false"}, {});
  dies.play({1, 1, {}});
  for (int i = 0; i < VariationProcess::kMaxStarts; i++) EXPECT_TRUE(image_of(dies).bytes.empty());
  (void)image_of(dies);
  EXPECT_EQ(dies.error(), "the simulation has ended unexpectedly");

  VariationProcess missing({"/no/such/program"}, {});
  missing.play({1, 1, {}});
  EXPECT_TRUE(image_of(missing).bytes.empty());
  EXPECT_NE(missing.error().find("can't be started"), std::string::npos) << missing.error();

  VariationProcess nonsense({"sh", "-c", "read x; echo {}; sleep 100"}, {});
  nonsense.play({1, 1, {}});
  for (int i = 0; i < VariationProcess::kMaxStarts; i++) EXPECT_TRUE(image_of(nonsense).bytes.empty());
  EXPECT_EQ(nonsense.error(), "the simulation answers nonsense");
}

TEST(Breed, PlaysASceneThatWasCorrected) {
  const TempFolder folder;
  const std::string scene = folder.file("ball.lua", "nonsense(");
  VariationProcess process(variation_command(), {scene, 0, {"place", "size"}});
  process.play({1, 1, {0, 0}});
  EXPECT_TRUE(image_of(process).bytes.empty());
  EXPECT_TRUE(process.failed());
  folder.file("ball.lua", kBall);
  process.play({2, 1, {0, 0}});
  EXPECT_EQ(image_of(process).width, 64) << process.error();
  folder.file("ball.lua", "nonsense(");
  process.play({3, 1, {0, 0}});
  EXPECT_TRUE(image_of(process).bytes.empty());
  EXPECT_TRUE(process.failed());  // its image is that of the run before
}

/// It doesn't finish the computation, which would take seconds, and doesn't answer.
TEST(Breed, AProcessEndsWithItsInput) {
  const TempFolder folder;
  const experiments::WorkerSetup setup{folder.file("loop.lua", "while true do end"), 0, {}};
  ImageRequest request;
  request.width = request.height = 8;
  system::ChildProcess process;
  ASSERT_EQ(process.start_quietly(variation_command()), 0);
  EXPECT_TRUE(process.write(experiments::encode(setup) + "\n" + encode(request) + "\n"));
  EXPECT_TRUE(process.finish());
  char byte = 0;
  EXPECT_EQ(system::read_some(process.output(), &byte, 1), 0);
}

TEST(Breed, GivesUpAProcessThatDoesNotAnswer) {
  const PipeSignalIgnored ignored;
  VariationProcess process({"sleep", "1000"}, {});
  process.play({1, 1, {}});
  ImageRequest request;
  request.width = request.height = 8;
  double now = 100;
  for (int i = 0; i < VariationProcess::kMaxStarts; i++) {
    process.request(request, now);
    process.check(now + VariationProcess::kAnswerLimit - 1);
    EXPECT_GE(process.descriptor(), 0);
    now += VariationProcess::kAnswerLimit + 1;
    process.check(now);
    EXPECT_LT(process.descriptor(), 0);
  }
  EXPECT_EQ(process.error(), "the simulation doesn't answer");
}

/// A session whose processes are never asked for images.
BreedSession session_in(const TempFolder& folder) {
  const std::vector<Axis> axes = {{"place", -2, 2, {}, false, {}, false},
                                  {"size", 0, 1, {0, 1}, true, {"small", "large"}, false}};
  BreedSession::Options options;
  options.command = {"false"};
  options.presets = {folder.path() + "/ball.presets.json", folder.path() + "/locks"};
  return {std::move(options), Breeding(axes, {{0.5, 0.25}}, 0.1, 1)};
}

BreedAction action(Kind kind, std::size_t index = 0) { return {kind, index, 0.1, "bred"}; }

TEST(Breed, KeepsTheLikedOnesAsPresets) {
  const TempFolder folder;
  BreedSession session = session_in(folder);
  session.perform(action(Kind::keep));
  EXPECT_TRUE(session.view().failed);
  for (const std::size_t liked : {2u, 7u}) session.perform(action(Kind::like, liked));
  session.perform(action(Kind::keep));
  EXPECT_NE(session.view().notice.find("Kept bred_1, bred_2 in "), std::string::npos) << session.view().notice;
  EXPECT_EQ(session.view().cells[7].preset, "bred_2");
  session.perform(action(Kind::mutate));
  EXPECT_EQ(session.view().cells[7].preset, "bred_2");  // it stays
  EXPECT_EQ(session.view().cells[8].preset, "");
  session.perform(action(Kind::like, 8));
  session.perform(action(Kind::keep));
  const auto presets = engine::parse_presets(content(folder.path() + "/ball.presets.json"));
  ASSERT_TRUE(presets);
  ASSERT_EQ(presets->presets.size(), 3u);
  EXPECT_EQ(presets->presets[2]->name, "bred_3");
  const std::string place = session.view().cells[8].values[0];
  EXPECT_EQ(fmt::format("{:.4g}", presets->presets[2]->values[0]), place);
}

TEST(Breed, KeepsAVariationOnce) {
  const TempFolder folder;
  BreedSession session = session_in(folder);
  session.perform(action(Kind::like, 2));
  session.perform(action(Kind::keep));
  session.perform(action(Kind::keep));
  EXPECT_EQ(session.view().notice, "bred_1 is kept already");
  session.perform(action(Kind::like, 3));
  session.perform(action(Kind::keep));
  EXPECT_EQ(session.view().cells[3].preset, "bred_2");
  BreedAction other = action(Kind::keep);
  other.name = "calm";
  session.perform(other);
  EXPECT_EQ(session.view().cells[2].preset, "calm_1");
  EXPECT_EQ(session.view().cells[3].preset, "calm_2");
}

TEST(Breed, RejectsANameThatPresetsCannotHave) {
  const TempFolder folder;
  BreedSession session = session_in(folder);
  session.perform(action(Kind::like, 2));
  for (const std::string& name : {std::string(), std::string(1000, 'x'), std::string("a\tb")}) {
    BreedAction keep = action(Kind::keep);
    keep.name = name;
    session.perform(keep);
    EXPECT_TRUE(session.view().failed) << name;
    EXPECT_FALSE(std::filesystem::exists(folder.path() + "/ball.presets.json"));
  }
}

TEST(Breed, PresetsFromAFileHaveTheirValues) {
  const TempFolder folder;
  const std::vector<Axis> axes = {{"place", -2, 2, {}, false, {}, false},
                                  {"size", 0, 2, {0, 1, 2}, true, {"small", "medium", "large"}, false},
                                  {"on", 0, 1, {0, 1}, true, {}, true}};
  const PresetStore store{folder.path() + "/a.presets.json", ""};
  const std::vector<std::vector<double>> values = {{0.25, 2, 0}, {-2, 1, 1}};
  std::string notice;
  ASSERT_TRUE(store.add(axes, values, "bred", notice));
  const Result<engine::PresetList> presets = store.read();
  ASSERT_TRUE(presets);
  ASSERT_EQ(presets->size(), 2u);
  for (std::size_t i = 0; i < 2; i++) EXPECT_EQ(parameter_values(*(*presets)[i], axes, {0, 0, 0}), values[i]) << i;
  // a word that is no choice, and a word in place of a number
  std::vector<Axis> others = axes;
  others[1].choices = {"tiny", "huge"};
  others[2].choices = {"no", "yes"};
  EXPECT_EQ(parameter_values(*(*presets)[0], others, {1, 1, 1}), (std::vector<double>{0.25, 1, 1}));
}

TEST(Breed, ReportsAFileThatCannotBeWritten) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path() + "/ball.presets.json");
  BreedSession session = session_in(folder);
  session.perform(action(Kind::like, 1));
  session.perform(action(Kind::keep));
  EXPECT_TRUE(session.view().failed);
  EXPECT_NE(session.view().notice.find("ball.presets.json"), std::string::npos) << session.view().notice;
}

TEST(Breed, OperationsChangeTheView) {
  const TempFolder folder;
  BreedSession session = session_in(folder);
  const panel::BreedView first = session.view();
  EXPECT_TRUE(first.cells[0].kept);
  EXPECT_EQ(first.cells[0].values, (std::vector<std::string>{"0", "small"}));
  session.perform(action(Kind::hold, 1));
  session.perform(action(Kind::like, 3));
  session.perform(action(Kind::randomize));
  EXPECT_TRUE(session.view().parameters[1].held);
  EXPECT_EQ(session.view().cells[3].values, first.cells[3].values);
  EXPECT_NE(session.view().cells[4].values[0], first.cells[4].values[0]);
  session.perform(action(Kind::undo));
  EXPECT_EQ(session.view().cells[4].values, first.cells[4].values);
  EXPECT_TRUE(session.view().cells[3].liked);
  session.perform(action(Kind::redo));
  EXPECT_FALSE(session.view().can_redo);
  for (std::size_t i = 0; i < BreedSession::kCount; i++) session.perform(action(Kind::like, i));
  session.perform(action(Kind::cross));
  EXPECT_TRUE(session.view().failed);
  session.perform(action(Kind::pause));
  EXPECT_TRUE(session.view().paused);
  session.perform(action(Kind::follow));
  EXPECT_TRUE(session.view().following);
}

TEST(Breed, MessagesKeepTheirContent) {
  ImageRequest request{64, 36, true, true, {1.5, -2, 3, 4, -5}};
  const auto same = decode_image_request(encode(request));
  ASSERT_TRUE(same);
  EXPECT_EQ(encode(*same), encode(request));
  const ImageHeader header{7, 64, 36, "über\n\xff"};
  const auto read = decode_image_header(encode(header));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->bytes(), 64u * 36 * 4);
  EXPECT_EQ(read->error.substr(0, 6), "über\n");
  for (const char* bad :
       {"", "{}", "[]", R"({"image":[0,5],"paused":false,"follow":false,"mouse":[0,0,0,0,0]})",
        R"({"image":[1e9,5],"paused":false,"follow":false,"mouse":[0,0,0,0,0]})",
        R"({"image":[5,5],"paused":false,"follow":false,"mouse":[0,0,0,0]})",
        R"({"number":1,"image":[5,-5],"error":""})", R"({"number":1,"image":[5,99999],"error":""})"}) {
    EXPECT_FALSE(decode_image_request(bad)) << bad;
    EXPECT_FALSE(decode_image_header(bad)) << bad;
  }
}

TEST(Breed, PlaysOnADisplay) {
  const TempFolder folder;
  folder.file("ball.lua", kBall);
  const Display display("320x240x24");
  std::vector<std::string> words{"env"};
  for (std::string& setting : display.environment()) words.push_back(std::move(setting));
  for (const char* word : {LIMBER_PROGRAM, "breed", "ball.lua", "--size", "320x240", "--quality", "low"})
    words.emplace_back(word);
  Process program(words, folder.path());
  ASSERT_TRUE(program.wait_for("window 320"));
  display.xdotool({"mousemove", "30", "30"});
  const std::string file = folder.path() + "/ball.presets.json";
  // keys that arrive before the window is ready are lost
  for (int i = 0; i < 10000 && !std::filesystem::exists(file); i++) {
    display.xdotool({"key", "5"});
    display.xdotool({"key", "k"});
    program.read_available();
  }
  program.signal(SIGTERM);
  EXPECT_EQ(program.finish().code, 0);
  const RunResult played =
      run({"ball.lua", "--preset", "bred_1", "--fast", "--duration", "0.1", "--hash"}, folder.path());
  EXPECT_EQ(played.code, 0) << played.err;
}

TEST(Breed, SaysWhatIsMissing) {
  const TempFolder folder;
  folder.file("ball.lua", kBall);
  folder.file("plain.lua", "sim.gravity = vec3()");
  const auto result = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"env", "DISPLAY=", "WAYLAND_DISPLAY=", LIMBER_PROGRAM, "breed"});
    return Process(words, folder.path()).finish();
  };
  EXPECT_EQ(result({"ball.lua"}).code, 3);
  EXPECT_NE(result({"ball.lua"}).err.find("breed needs a window"), std::string::npos);
  EXPECT_EQ(result({"plain.lua"}).code, 2);
  EXPECT_EQ(result({"none.lua"}).code, 1);
  const RunResult wrong = result({"ball.lua", "--param", "plase=0:1"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("did you mean 'place'"), std::string::npos) << wrong.err;
  const RunResult preset = result({"ball.lua", "--from", "calm"});
  EXPECT_EQ(preset.code, 2);
  EXPECT_NE(preset.err.find("--from calm: there is no such preset in "), std::string::npos) << preset.err;
}

}  // namespace
}  // namespace limber::app::test
