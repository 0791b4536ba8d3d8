// Ticks out of a file, and the comparison of their hashes.
#include "engine/take_player.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/text.h"

namespace limber {

Result<std::unique_ptr<TakePlayer>> TakePlayer::open(const std::string& path, bool current_scripts) {
  auto reader = TakeReader::open(path);
  if (!reader) return Error{reader.error()};
  auto counted = TakeReader::open(path);
  if (!counted) return Error{counted.error()};
  std::unique_ptr<TakePlayer> player(new TakePlayer(std::move(*reader), current_scripts));
  player->whole_ = (*counted)->count_ticks();
  player->read_ahead();
  if (!player->ahead()) {
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
  const bool known = found_.parted && !current_ && (looking_ == 0 || !found_.body.empty());
  if (!ahead() || known) {
    over_ = true;
    return false;
  }
  std::swap(tick_, ahead_[ahead_at_++]);
  if (!ahead()) read_ahead();
  next_run_ = 0;
  if (tick_.running) found_.ticks++;
  return true;
}

const TakeRun* TakePlayer::take_run(TakeRun::Kind kind) {
  if (!comes(kind)) return nullptr;
  return &tick_.runs[next_run_++];
}

const TakeRun* TakePlayer::run_from_outside() const {
  if (next_run_ >= tick_.runs.size() || !tick_.runs[next_run_].from_outside()) return nullptr;
  return &tick_.runs[next_run_];
}

void TakePlayer::find_body(World& world) {
  looking_--;
  const std::span<const std::uint64_t> hashes = world.motion_hash().bodies();
  const auto& all = world.bodies();
  for (std::size_t i = 0; i < tick_.bodies.size(); i++) {
    const std::size_t at = tick_.first_body + i;
    if (at < all.size() && static_cast<std::uint16_t>(hashes[at]) == tick_.bodies[i]) continue;
    found_.body = at < all.size() ? all[at]->name() : fmt::format("number {}, which is not there now", at + 1);
    return;
  }
}

// the take's end has the whole state
bool TakePlayer::ends_well(const std::function<std::uint64_t()>& state_hash) const {
  return ahead() || !reader_->end() || state_hash() == reader_->end()->state;
}

void TakePlayer::compare(World& world, const CallLedger& calls, const std::function<std::uint64_t()>& state_hash) {
  if (!comparable()) return;
  const bool moves_alike = world.motion_hash().now() == tick_.motion && world.tick() == tick_.tick;
  const bool calls_alike = current_ || (calls.missed() == 0 && next_run_ == tick_.runs.size());
  const bool same =
      moves_alike && calls_alike && (!tick_.state || state_hash() == *tick_.state) && ends_well(state_hash);
  if (!same && !found_.parted) {
    found_.parted = tick_.tick;
    // the bodies take turns
    looking_ = tick_.bodies.empty() ? 1 : world.bodies().size() / tick_.bodies.size() + 2;
  }
  if (looking_ > 0 && found_.body.empty()) find_body(world);
}

TakeVerdict TakePlayer::verdict() const {
  TakeVerdict verdict = found_;
  if (!ahead()) verdict.damage = reader_->damage();
  verdict.cut_off = !ahead() && !reader_->end();
  verdict.compared = comparable();
  verdict.recorded_by = reader_->header().limber;
  return verdict;
}

std::string text_of(const TakeVerdict& v) {
  std::string text = fmt::format("replayed {} ticks: ", v.ticks);
  if (!v.compared) {
    text += fmt::format("nothing was compared, limber {} recorded it with other hashes", printable(v.recorded_by));
  } else if (!v.parted) {
    text += "every hash is the take's";
  } else {
    text += fmt::format("the runs part at tick {}; ", *v.parted);
    text += v.body.empty() ? std::string("no body moves otherwise yet, values or generators differ")
                           : fmt::format("the first body that differs is '{}'", printable(v.body));
    const std::string here = fmt::format("{} ({})", version(), commit());
    if (v.recorded_by != here)
      text += fmt::format("; it was recorded by limber {}, this is {}", printable(v.recorded_by), here);
  }
  if (!v.damage.empty()) return fmt::format("{}; the file is {}", text, v.damage);
  if (v.cut_off) text += "; the take was cut off there";
  return text;
}

}  // namespace limber
