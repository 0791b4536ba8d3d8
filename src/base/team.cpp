// Helpers watch for the next round for a moment, then sleep; within one, pieces are taken by counting down.
#include "base/team.h"

#include "base/check.h"
#include "base/fixed_math.h"
#include "base/system/clock.h"
#include "base/system/thread.h"

namespace limber {

namespace {

/// So long a member looks for what it waits for before it sleeps, s: what one thread does between two rounds of a tick,
/// and between two ticks of which one follows the other at once, is mostly shorter. To be woken takes some 70 µs, of
/// which whoever wakes it spends 45. Where ticks are paced all sleep between them.
constexpr double kWatch = 400e-6;

void pause_a_moment() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

// Who watches on another's processor only keeps that one from its work.
Team::Team(int members)
    : members_(members), watches_(static_cast<unsigned>(members) <= std::thread::hardware_concurrency()) {
  LIMBER_CHECK(members >= 1 && members <= kMost);
  for (int member = 1; member < members; member++) {
    std::thread helper;
    if (!system::start_thread(helper, [this, member] { help(member); })) {
      members_ = member;
      break;
    }
    helpers_.push_back(std::move(helper));
  }
}

Team::~Team() {
  ends_ = true;
  round_++;
  round_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::rouse() {
  round_++;
  round_.notify_all();
}

void Team::share(int pieces, Call call, void* of) {
  if (pieces <= 0) return;
  call_ = call;
  of_ = of;
  open_.store(pieces, std::memory_order_relaxed);
  const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
  int first = 0;
  for (int member = 0; member < members_; member++) {
    Part& part = parts_[static_cast<std::size_t>(member)];
    part.end = static_cast<int>(std::int64_t{pieces} * (member + 1) / members_);
    part.ticket.store(static_cast<std::uint64_t>(round) << kPieceBits | static_cast<std::uint32_t>(part.end - first));
    first = part.end;
  }
  round_.store(round);
  if (pieces > 1) round_.notify_all();
  take_pieces(round, 0);
  watch([&] { return open_.load() == 0; });
  for (int left = open_.load(); left != 0; left = open_.load()) open_.wait(left);
}

void Team::help(int member) {
  fixed::reset_arithmetic();
  system::name_this_thread("limber-team");
  std::uint32_t seen = 0;
  while (!ends_) {
    watch([&] { return round_.load() != seen; });
    round_.wait(seen);
    seen = round_.load();
    take_pieces(seen, member);
  }
}

// Until it is done, or the moment is over.
template <class Done>
void Team::watch(Done&& done) const {
  if (!watches_ || done()) return;
  const double end = system::clock_seconds() + kWatch;
  do {
    for (int i = 0; i < 16; i++) {
      if (done()) return;
      pause_a_moment();
    }
  } while (system::clock_seconds() < end);
}

// Its own part, then the others'.
void Team::take_pieces(std::uint64_t round, int member) {
  for (int i = 0; i < members_; i++) {
    Part& part = parts_[static_cast<std::size_t>((member + i) % members_)];
    std::uint64_t ticket = part.ticket.load();
    while (ticket >> kPieceBits == round && static_cast<std::uint32_t>(ticket) != 0) {
      if (!part.ticket.compare_exchange_weak(ticket, ticket - 1)) continue;
      call_(of_, part.end - static_cast<int>(static_cast<std::uint32_t>(ticket)), member);
      if (open_.fetch_sub(1) == 1) open_.notify_one();
      ticket = part.ticket.load();
    }
  }
}

}  // namespace limber
