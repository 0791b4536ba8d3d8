// Reading ahead, comparison of hashes, search for the first body that diverged.
#include "engine/takes/player.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/plural.h"
#include "base/text.h"
#include "sim/world/body.h"

namespace limber::engine {

Result<std::unique_ptr<TakePlayer>> TakePlayer::open(const std::string& path, bool current_scripts) {
  auto reader = TakeReader::open(path);
  if (!reader) return Error{reader.error()};
  auto counting_reader = TakeReader::open(path);
  if (!counting_reader) return Error{counting_reader.error()};
  std::unique_ptr<TakePlayer> player(new TakePlayer(std::move(*reader), current_scripts));
  player->total_ticks_ = (*counting_reader)->count_ticks();
  player->read_ahead();
  if (!player->has_more()) {
    const std::string& damage = player->reader_->damage();
    return Error{
        fmt::format("{}: {}", printable(path), damage.empty() ? "the take was cut off before its first tick" : damage)};
  }
  return player;
}

void TakePlayer::read_ahead() {
  ahead_at_ = ahead_end_ = 0;
  while (ahead_end_ < ahead_.size() && reader_->next(ahead_[ahead_end_])) ahead_end_++;
}

bool TakePlayer::next() {
  const bool search_done =
      result_.diverged_at && !current_scripts_ && (search_ticks_ == 0 || !result_.diverged_body.empty());
  if (!has_more() || search_done) {
    finished_ = true;
    return false;
  }
  std::swap(tick_, ahead_[ahead_at_++]);
  if (!has_more()) read_ahead();
  next_run_ = 0;
  if (tick_.running) result_.ticks++;
  return true;
}

const TakeSceneRun* TakePlayer::consume_run(TakeSceneRun::Kind kind) {
  if (!next_run_is(kind)) return nullptr;
  return &tick_.runs[next_run_++];
}

const TakeSceneRun* TakePlayer::next_external_run() const {
  if (next_run_ >= tick_.runs.size() || !tick_.runs[next_run_].is_external()) return nullptr;
  return &tick_.runs[next_run_];
}

void TakePlayer::find_diverged_body(sim::World& world) {
  search_ticks_--;
  const std::span<const std::uint64_t> hashes = world.motion_hash().body_hashes();
  const auto& all = world.bodies();
  for (std::size_t i = 0; i < tick_.body_hashes.size(); i++) {
    const std::size_t at = tick_.first_body + i;
    if (at < all.size() && static_cast<std::uint16_t>(hashes[at]) == tick_.body_hashes[i]) continue;
    result_.diverged_body =
        at < all.size() ? all[at]->name() : fmt::format("number {}, which does not exist in the replay", at + 1);
    return;
  }
}

// True unless the take ends with this tick and its final state hash differs.
bool TakePlayer::end_matches(const std::function<std::uint64_t()>& state_hash) const {
  return has_more() || !reader_->end() || state_hash() == reader_->end()->state_hash;
}

void TakePlayer::compare(sim::World& world, const script::CallLog& calls,
                         const std::function<std::uint64_t()>& state_hash) {
  if (!comparable()) return;
  const bool motion_matches = world.motion_hash().compute() == tick_.motion_hash && world.tick() == tick_.tick;
  const bool calls_match = current_scripts_ || (calls.missing_stops() == 0 && next_run_ == tick_.runs.size());
  const bool matches = motion_matches && calls_match && (!tick_.state_hash || state_hash() == *tick_.state_hash) &&
                       end_matches(state_hash);
  if (!matches && !result_.diverged_at) {
    result_.diverged_at = tick_.tick;
    // each tick has hashes of only some bodies: search until all of them had their turn
    search_ticks_ = tick_.body_hashes.empty() ? 1 : world.bodies().size() / tick_.body_hashes.size() + 2;
  }
  if (search_ticks_ > 0 && result_.diverged_body.empty()) find_diverged_body(world);
}

ReplayResult TakePlayer::result() const {
  ReplayResult result = result_;
  if (!has_more()) result.damage = reader_->damage();
  result.truncated = !has_more() && !reader_->end();
  result.compared = comparable();
  result.recorded_by = reader_->header().limber;
  return result;
}

std::string text_of(const ReplayResult& v) {
  std::string text = fmt::format("replayed {}: ", counted(v.ticks, "tick"));
  if (!v.compared) {
    text += fmt::format("nothing was compared, limber {} recorded it with other hashes", printable(v.recorded_by));
  } else if (!v.diverged_at) {
    text += "all hashes match the take";
  } else {
    text += fmt::format("diverged at tick {}; ", *v.diverged_at);
    text += v.diverged_body.empty() ? std::string("no body moves differently yet; values or random generators differ")
                                    : fmt::format("the first body that differs is '{}'", printable(v.diverged_body));
    const std::string this_version = fmt::format("{} ({})", version(), commit());
    if (v.recorded_by != this_version)
      text += fmt::format("; it was recorded by limber {}, this is {}", printable(v.recorded_by), this_version);
  }
  if (!v.damage.empty()) return fmt::format("{}; the file is {}", text, v.damage);
  if (v.truncated) text += "; the take was cut off there";
  return text;
}

}  // namespace limber::engine
