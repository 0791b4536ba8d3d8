// LinkSession: the thread that reads and writes lines.
#include "net/link/link_session.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "base/system/clock.h"
#include "base/system/file.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::link {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;             // ns
constexpr std::int64_t kRetryProgram = 5 * kSecond;         // ns
constexpr std::int64_t kSilence = 5 * kSecond;              // ns without a line after which the program counts as hung
constexpr std::size_t kMaxReceived = std::size_t{1} << 16;  // bytes
constexpr double kTempoTolerance = 1e-3;                    // beats per minute

}  // namespace

std::vector<Message> LinkTranslator::messages(const LinkLine& line, const sim::ClockReading& clock) {
  std::vector<Message> list;
  list.push_back({"/clock/sync", {Arg::of(line.beat), Arg::of(line.tempo), Arg::of(line.time)}});
  // sessions in which no program starts and stops always have the same value
  const bool changed = playing_ && *playing_ != line.playing && line.playing != clock.playing;
  if (changed) list.push_back({"/clock/playing", {Arg::of(line.playing)}});
  playing_ = line.playing;
  return list;
}

std::string LinkTranslator::lines(const sim::ClockReading& clock, std::uint64_t tick) {
  std::string text;
  // another scene, or a reset, doesn't change the tempo of a session
  const bool restarted = tick < tick_;
  tick_ = tick;
  const std::optional<sim::ClockReading> last = std::exchange(last_, clock);
  if (!last) return text;
  const bool set = std::abs(clock.set_tempo - last->set_tempo) > kTempoTolerance;
  if (set && !restarted) text += fmt::format("tempo {}\n", clock.set_tempo);
  if (clock.beats_per_bar != last->beats_per_bar) text += fmt::format("bar {}\n", clock.beats_per_bar);
  if (clock.playing != last->playing && !restarted && clock.playing != playing_.value_or(!clock.playing)) {
    text += fmt::format("playing {}\n", clock.playing ? 1 : 0);
    playing_ = clock.playing;
  }
  return text;
}

void LinkSession::start() {
  if (thread_.joinable()) return;
  stop_ = false;
  thread_ = std::thread([this] { run(); });
}

void LinkSession::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  wake_.notify();
  thread_.join();
  process_.kill();
}

std::int64_t LinkSession::update_program(std::int64_t now) {
  if (process_.started()) {
    if (now - heard_at_ > kSilence) end_program("it does not answer", now);
    return kSecond;
  }
  if (now < retry_at_) return retry_at_ - now;
  const std::shared_ptr<const engine::Snapshot> snapshot = link_.snapshots.read();
  if (snapshot == nullptr) return kSecond / 20;
  const int fault = process_.start_quietly(
      {program_, fmt::format("{}", snapshot->clock.tempo), fmt::format("{}", snapshot->clock.beats_per_bar)});
  heard_at_ = now;
  received_.clear();
  translator_ = {};
  if (fault != 0) end_program(std::generic_category().message(fault).c_str(), now);
  return kSecond;
}

void LinkSession::end_program(const char* reason, std::int64_t now) {
  process_.kill();
  retry_at_ = now + kRetryProgram;
  if (std::exchange(reported_, true)) return;
  log_warning(
      "Link: {} has ended or can't be started: {}. It is built with Limber if the package ableton-link-dev is "
      "installed; trying again every 5 seconds",
      printable(program_), reason);
}

void LinkSession::read_lines(std::int64_t now) {
  std::array<char, 4096> bytes;
  const std::ptrdiff_t count = system::read_some(process_.output(), bytes.data(), bytes.size());
  if (count <= 0) return end_program("it has ended", now);
  received_.append(bytes.data(), static_cast<std::size_t>(count));
  heard_at_ = now;
  for (std::size_t end = received_.find('\n'); end != std::string::npos; end = received_.find('\n')) {
    handle(std::string_view(received_).substr(0, end));
    received_.erase(0, end + 1);
  }
  if (received_.size() > kMaxReceived) end_program("it sends no lines", now);
}

void LinkSession::handle(std::string_view text) {
  const std::optional<LinkLine> line = parse_link_line(text);
  const std::shared_ptr<const engine::Snapshot> snapshot = link_.snapshots.read();
  if (!line || snapshot == nullptr) return;
  if (std::exchange(reported_, false)) log_info("Link: {} runs again", printable(program_));
  if (line->peers != peers_)
    log_info("Link: {} in the session, {} beats per minute", counted(line->peers, "other program"),
             number_text(line->tempo));
  peers_ = line->peers;
  const std::string lines = translator_.lines(snapshot->clock, snapshot->tick);
  if (!lines.empty() && !process_.write(lines)) return;
  link_.command_queue.push({translator_.messages(*line, snapshot->clock), {CommandSource::command_line}});
  link_.wake_engine();
}

void LinkSession::run() {
  system::name_this_thread("limber-link");
  while (!stop_.load()) {
    const std::int64_t wait = update_program(system::clock_nanoseconds());
    std::array<system::PollEntry, 2> entries{};
    entries[0] = {.fd = wake_.fd()};
    entries[1] = {.fd = process_.started() ? process_.output() : -1};
    (void)system::wait_ready(entries, std::chrono::nanoseconds(wait));
    wake_.clear();
    if (process_.started() && entries[1].ready) read_lines(system::clock_nanoseconds());
  }
}

}  // namespace limber::link
