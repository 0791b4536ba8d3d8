// Helpers sleep between two rounds; within one, pieces are taken by counting down.
#include "base/team.h"

#include <pthread.h>

#include "base/check.h"

namespace limber {

Team::Team(int members) {
  LIMBER_CHECK(members >= 1 && members <= kMost);
  for (int member = 1; member < members; member++) {
    helpers_.emplace_back([this, member] { help(member); });
    pthread_setname_np(helpers_.back().native_handle(), "limber-team");
  }
}

Team::~Team() {
  ends_ = true;
  round_++;
  round_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::share(int pieces, Call call, void* of) {
  if (pieces <= 0) return;
  call_ = call;
  of_ = of;
  open_.store(pieces, std::memory_order_relaxed);
  const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
  ticket_.store(static_cast<std::uint64_t>(round) << kPieceBits | static_cast<std::uint32_t>(pieces));
  round_.store(round);
  if (pieces > 1) round_.notify_all();
  take_pieces(round, 0);
  for (int left = open_.load(); left != 0; left = open_.load()) open_.wait(left);
}

void Team::help(int member) {
  std::uint32_t seen = 0;
  while (!ends_) {
    round_.wait(seen);
    seen = round_.load();
    take_pieces(seen, member);
  }
}

void Team::take_pieces(std::uint64_t round, int member) {
  std::uint64_t ticket = ticket_.load();
  while (ticket >> kPieceBits == round && static_cast<std::uint32_t>(ticket) != 0) {
    if (!ticket_.compare_exchange_weak(ticket, ticket - 1)) continue;
    call_(of_, static_cast<int>(static_cast<std::uint32_t>(ticket)) - 1, member);
    if (open_.fetch_sub(1) == 1) open_.notify_one();
    ticket = ticket_.load();
  }
}

}  // namespace limber
