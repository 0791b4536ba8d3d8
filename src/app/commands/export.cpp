// Replays a take and samples it at the export's frame rate.
#include "app/commands/commands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/motion/motion_source.h"
#include "app/paths.h"
#include "app/progress.h"
#include "app/view/offline_clock.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/signals.h"
#include "base/text.h"
#include "engine/takes/reader.h"
#include "export/writers.h"
#include "sim/world/body.h"

namespace limber::app {

namespace {

namespace fs = std::filesystem;

enum class Format : std::uint8_t { csv, bvh, gltf };

struct Extension {
  std::string_view text;
  Format format;
};
constexpr std::array kExtensions = {Extension{".csv", Format::csv}, Extension{".bvh", Format::bvh},
                                    Extension{".glb", Format::gltf}, Extension{".gltf", Format::gltf}};

std::optional<Format> format_of(std::string_view output) {
  for (const Extension& extension : kExtensions) {
    if (output.ends_with(extension.text)) return extension.format;
  }
  return {};
}

struct Plan {
  Format format = Format::csv;
  std::string output;
};

// determines format and file from the options; they must agree
Result<Plan> make_plan(const ExportCommand& command) {
  const std::optional<Format> by_name = format_of(command.output);
  Plan plan;
  if (command.format.empty()) {
    if (!by_name)
      return Error{
          "no format: use --format csv, bvh or gltf, or -o with a name that ends with .csv, .bvh, .glb or .gltf"};
    plan = {*by_name, command.output};
    return plan;
  }
  plan.format = *format_of("." + command.format);
  plan.output = command.output;
  if (plan.output.empty()) {
    const fs::path take(command.take);
    const char* const suffix = plan.format == Format::csv ? ".csv" : plan.format == Format::gltf ? ".glb" : "_bvh";
    plan.output = (take.parent_path() / (take.stem().string() + suffix)).string();
  }
  if (by_name ? *by_name == plan.format : plan.format == Format::bvh) return plan;
  if (command.output.empty()) return plan;
  return Error{fmt::format("-o '{}' doesn't match --format {}: the name must {}", printable(command.output),
                           command.format,
                           plan.format == Format::csv   ? "end with .csv"
                           : plan.format == Format::bvh ? "end with .bvh, or be that of a folder"
                                                        : "end with .glb or .gltf")};
}

// make_plan(), and a check of the options that belong to one format
Result<Plan> make_checked_plan(const ExportCommand& command) {
  Result<Plan> plan = make_plan(command);
  if (plan && plan->format != Format::csv && !command.extras.empty())
    return Error{"--with adds columns to a table; use it with --format csv"};
  return plan;
}

// fails if an existing file would be overwritten
Result<void> check_not_existing(const Plan& plan, bool overwrite) {
  std::vector<std::string> names = {plan.output};
  if (plan.output.ends_with(".gltf")) names.push_back(fs::path(plan.output).replace_extension(".bin").string());
  for (const std::string& name : names) {
    std::error_code none;
    const fs::file_status status = fs::symlink_status(name, none);
    if (!fs::exists(status)) continue;
    if (fs::is_directory(status))
      return Error{fmt::format("{} is an existing folder, which is never overwritten: choose another name with -o",
                               printable(name))};
    if (!overwrite)
      return Error{fmt::format("{} already exists: choose another name with -o, or overwrite it with --overwrite",
                               printable(name))};
  }
  return {};
}

Result<std::unique_ptr<exporter::MotionWriter>> open_writer(const Plan& plan, double rate) {
  if (plan.format == Format::csv) return exporter::make_csv_writer(plan.output);
  if (plan.format == Format::bvh) return exporter::make_bvh_writer(plan.output, rate);
  return exporter::make_gltf_writer(plan.output);
}

MotionExtras extras_of(const ExportCommand& command) {
  const auto has = [&](std::string_view name) {
    return std::ranges::find(command.extras, name) != command.extras.end();
  };
  return {has("velocities"), has("torques"), has("contacts")};
}

// number of ticks that advance time
Result<std::uint64_t> ticks_of(const std::string& take) {
  auto opened = engine::TakeReader::open(take);
  if (!opened) return Error{opened.error()};
  std::uint64_t ticks = 0;
  for (engine::RecordedPass tick; (*opened)->next(tick);) ticks += tick.running ? 1 : 0;
  return ticks;
}

engine::EngineOptions engine_options(const ExportCommand& command) {
  engine::EngineOptions options;
  options.scene_options.data_dir = data_dir();
  options.fast = true;
  options.print = false;
  options.replay = command.take;
  return options;
}

struct ExportResult {
  std::uint64_t frames = 0;
  bool canceled = false;
  Result<void> written;
};

// writes all frames up to the end of the take or the requested time
ExportResult write_frames(const ExportCommand& command, std::uint64_t ticks, engine::Engine& engine,
                          OfflineClock& clock, MotionSource& source, exporter::MotionWriter& writer) {
  const auto wanted = command.to ? std::llround(std::floor((*command.to - command.from) * command.rate + 1e-6)) + 1 : 0;
  Progress progress(command.to ? "frame" : "tick", command.to ? static_cast<std::uint64_t>(wanted) : ticks);
  ExportResult end;
  std::uint64_t done = 0;
  clock.on_after_tick([&] {
    source.update(engine.world(), clock.now());
    if (clock.now().time != clock.before().time) done++;
    progress.report(command.to ? end.frames : done);
  });
  source.update(engine.world(), clock.now());
  for (; !command.to || end.frames < static_cast<std::uint64_t>(wanted); end.frames++) {
    const double at = command.from + static_cast<double>(end.frames) / command.rate;
    const OfflineClock::Outcome outcome = clock.advance_to(at);
    end.canceled = outcome == OfflineClock::Outcome::canceled;
    if (outcome != OfflineClock::Outcome::reached) break;
    end.written = source.add_frame(at, clock.before(), clock.now(), clock.mix(at), writer);
    if (!end.written) break;
  }
  return end;
}

int report_result(const Plan& plan, const ExportCommand& command, const ExportResult& end, const MotionSource& source,
                  const engine::Engine& engine) {
  print_notice("{}: {} of {}, {} a second", printable(plan.output), counted(end.frames, "frame"),
               counted(source.bodies(), "body", "bodies"), number_text(command.rate));
  const engine::ReplayResult result = engine.replay_result();
  print_notice("{}", engine::text_of(result));
  return result.diverged_at || !result.damage.empty() ? kInputError : kSuccess;
}

}  // namespace

int export_take(const ExportCommand& command, const std::function<bool()>& cancel) {
  const Result<Plan> plan = make_checked_plan(command);
  if (!plan) return fail(kUsageError, plan.error());
  if (command.to && *command.to < command.from)
    return fail(kUsageError, fmt::format("--to {} is before --from {}; choose a later time", number_text(*command.to),
                                         number_text(command.from)));
  if (const Result<void> can_write = check_not_existing(*plan, command.overwrite); !can_write)
    return fail(kInputError, can_write.error());
  const Result<std::uint64_t> ticks = ticks_of(command.take);
  if (!ticks) return fail(kInputError, ticks.error());
  engine::EngineLink link;
  engine::Engine engine(link, engine_options(command));
  if (const Result<void> started = engine.start(); !started) return fail(kInputError, started.error());
  Result<std::unique_ptr<exporter::MotionWriter>> writer = open_writer(*plan, command.rate);
  if (!writer) return fail(kInputError, writer.error());
  OfflineClock clock(engine, link, cancel);
  MotionSource source(command.bodies, extras_of(command));
  const ExportResult end = write_frames(command, *ticks, engine, clock, source, **writer);
  if (!end.written) return fail(kMachineError, end.written.error());
  if (end.canceled) {
    print_notice("cancelled; {} was not written", printable(plan->output));
    return kInputError;
  }
  if (end.frames == 0)
    return fail(kInputError, fmt::format("the take ends at {:.2f} s, before --from {}; choose an earlier time",
                                         clock.elapsed(), number_text(command.from)));
  if (source.bodies() == 0 && !command.bodies.empty())
    return fail(kInputError, fmt::format("no body '{}' in the take{}", printable(command.bodies.front()),
                                         name_hint(command.bodies.front(), source.names())));
  if (const Result<void> finished = (*writer)->finish(); !finished) return fail(kMachineError, finished.error());
  return report_result(*plan, command, end, source, engine);
}

int export_command(const ExportCommand& command) {
  system::block_signals();
  start_output(OutputMode::batch);
  return export_take(command, system::signal_arrived);
}

}  // namespace limber::app
