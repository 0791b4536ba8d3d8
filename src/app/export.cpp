// A replay that is looked at so many times a second.
#include "app/export.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/moments.h"
#include "app/motion_source.h"
#include "app/paths.h"
#include "app/progress.h"
#include "base/output.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "engine/take_reader.h"
#include "motion/bvh.h"
#include "motion/csv.h"
#include "motion/gltf.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

enum class Format : std::uint8_t { csv, bvh, gltf };

struct Ending {
  std::string_view text;
  Format format;
};
constexpr std::array kEndings = {Ending{".csv", Format::csv}, Ending{".bvh", Format::bvh}, Ending{".glb", Format::gltf},
                                 Ending{".gltf", Format::gltf}};

std::optional<Format> format_of(std::string_view output) {
  for (const Ending& ending : kEndings) {
    if (output.ends_with(ending.text)) return ending.format;
  }
  return {};
}

struct Plan {
  Format format = Format::csv;
  std::string output;
};

// format and output say the same, or one of them says both
Result<Plan> plan_of(const ExportCommand& command) {
  const std::optional<Format> by_name = format_of(command.output);
  Plan plan;
  if (command.format.empty()) {
    if (!by_name)
      return Error{"say --format csv, bvh or gltf, or give -o a name that ends with .csv, .bvh, .glb or .gltf"};
    plan = {*by_name, command.output};
    return plan;
  }
  plan.format = *format_of("." + command.format);
  plan.output = command.output;
  if (plan.output.empty()) {
    const fs::path take(command.take);
    const char* const ending = plan.format == Format::csv ? ".csv" : plan.format == Format::gltf ? ".glb" : "_bvh";
    plan.output = (take.parent_path() / (take.stem().string() + ending)).string();
  }
  if (by_name ? *by_name == plan.format : plan.format == Format::bvh) return plan;
  if (command.output.empty()) return plan;
  return Error{fmt::format("-o '{}' is no name for --format {}: {}", printable(command.output), command.format,
                           plan.format == Format::csv   ? "one that ends with .csv would do"
                           : plan.format == Format::bvh ? "one that ends with .bvh, or a folder's, would do"
                                                        : "one that ends with .glb or .gltf would do")};
}

// whether something that is there would be lost
Result<void> check_free(const Plan& plan, bool overwrite) {
  std::vector<std::string> names = {plan.output};
  if (plan.output.ends_with(".gltf")) names.push_back(fs::path(plan.output).replace_extension(".bin").string());
  for (const std::string& name : names) {
    std::error_code none;
    const fs::file_status status = fs::symlink_status(name, none);
    if (!fs::exists(status)) continue;
    if (fs::is_directory(status))
      return Error{
          fmt::format("{} is a folder that is there already, and none is written over: choose another name by -o",
                      printable(name))};
    if (!overwrite)
      return Error{fmt::format("{} is there already: choose another name by -o, or write over it by --overwrite",
                               printable(name))};
  }
  return {};
}

Result<std::unique_ptr<MotionWriter>> open_writer(const Plan& plan, double rate) {
  if (plan.format == Format::csv) return write_csv(plan.output);
  if (plan.format == Format::bvh) return write_bvh(plan.output, rate);
  return write_gltf(plan.output);
}

// ticks in which time goes on
Result<std::uint64_t> ticks_of(const std::string& take) {
  auto opened = TakeReader::open(take);
  if (!opened) return Error{opened.error()};
  std::uint64_t ticks = 0;
  for (TakeTick tick; (*opened)->next(tick);) ticks += tick.running ? 1 : 0;
  return ticks;
}

EngineOptions engine_options(const ExportCommand& command) {
  EngineOptions options;
  options.scene_options.data_dir = data_dir();
  options.fast = true;
  options.print = false;
  options.replay = command.take;
  return options;
}

struct Ended {
  std::uint64_t frames = 0;
  bool cancelled = false;
  Result<void> written;
};

// every frame, to the end of the take or of what was asked for
Ended write_frames(const ExportCommand& command, std::uint64_t ticks, Engine& engine, Moments& moments,
                   MotionSource& source, MotionWriter& writer) {
  const auto wanted = command.to ? std::llround(std::floor((*command.to - command.from) * command.rate + 1e-6)) + 1 : 0;
  Progress progress(command.to ? "frame" : "tick", command.to ? static_cast<std::uint64_t>(wanted) : ticks);
  Ended end;
  std::uint64_t done = 0;
  moments.after_tick([&] {
    source.learn(engine.world(), moments.now());
    if (moments.now().time != moments.before().time) done++;
    progress.tell(command.to ? end.frames : done);
  });
  source.learn(engine.world(), moments.now());
  for (; !command.to || end.frames < static_cast<std::uint64_t>(wanted); end.frames++) {
    const double at = command.from + static_cast<double>(end.frames) / command.rate;
    const Moments::Went went = moments.go_to(at);
    end.cancelled = went == Moments::Went::cancelled;
    if (went != Moments::Went::there) break;
    end.written = source.add_frame(at, moments.before(), moments.now(), moments.mix(at), writer);
    if (!end.written) break;
  }
  return end;
}

int tell_end(const Plan& plan, const ExportCommand& command, const Ended& end, const MotionSource& source,
             const Engine& engine) {
  print_notice("{}: {} frames of {} bod{}, {} a second", printable(plan.output), end.frames, source.bodies(),
               source.bodies() == 1 ? "y" : "ies", number_text(command.rate));
  const TakeVerdict verdict = engine.verdict();
  print_notice("{}", text_of(verdict));
  return verdict.parted || !verdict.damage.empty() ? kInput : kFine;
}

}  // namespace

int export_take(const ExportCommand& command, const std::function<bool()>& cancel) {
  const Result<Plan> plan = plan_of(command);
  if (!plan) return fail(kUsage, plan.error());
  if (command.to && *command.to < command.from)
    return fail(kUsage, fmt::format("--to {} lies before --from {}; give a time behind it", number_text(*command.to),
                                    number_text(command.from)));
  if (const Result<void> is_free = check_free(*plan, command.overwrite); !is_free) return fail(kInput, is_free.error());
  const Result<std::uint64_t> ticks = ticks_of(command.take);
  if (!ticks) return fail(kInput, ticks.error());
  EngineLink link;
  Engine engine(link, engine_options(command));
  if (const Result<void> started = engine.start(); !started) return fail(kInput, started.error());
  Result<std::unique_ptr<MotionWriter>> writer = open_writer(*plan, command.rate);
  if (!writer) return fail(kInput, writer.error());
  Moments moments(engine, link, cancel);
  MotionSource source(command.bodies);
  const Ended end = write_frames(command, *ticks, engine, moments, source, **writer);
  if (!end.written) return fail(kMachine, end.written.error());
  if (end.cancelled) {
    print_notice("cancelled; there is no {}", printable(plan->output));
    return kInput;
  }
  if (end.frames == 0)
    return fail(kInput, fmt::format("the take ends at {:.2f} s, before --from {}; begin earlier", moments.elapsed(),
                                    number_text(command.from)));
  if (source.bodies() == 0 && !command.bodies.empty())
    return fail(kInput, fmt::format("no body of the take is called '{}'{}", printable(command.bodies.front()),
                                    name_hint(command.bodies.front(), source.names())));
  if (const Result<void> finished = (*writer)->finish(); !finished) return fail(kMachine, finished.error());
  return tell_end(*plan, command, end, source, engine);
}

int export_command(const ExportCommand& command) {
  system::block_signals();
  start_output(OutputMode::batch);
  return export_take(command, system::signal_came);
}

}  // namespace limber
