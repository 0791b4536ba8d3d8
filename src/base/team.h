// Team: some threads that share out the pieces of one work; the caller is one of them. Each has a part of the pieces
// that it does first, the same part of every work, so that what it will look at again is still in its cache; who is
// done helps the others.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace limber {

class Team {
 public:
  static constexpr int kMost = 64;

  /// `members` from 1 to kMost, the caller of run() counted: so many threads less one are started, or as many as the
  /// system has left; the result of work is the same.
  explicit Team(int members);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int members() const { return members_; }

  /// Soon there will be work: who sleeps wakes up meanwhile. [as run()]
  void rouse();

  /// Calls work(piece, member) once for each piece from 0 to pieces - 1, by a member each (0: the caller), and
  /// returns when all are done. Nothing is allocated. The work must not throw. [one thread at a time]
  template <class Work>
  void run(int pieces, Work&& work) {
    share(
        pieces,
        [](void* of, int piece, int member) { (*static_cast<std::remove_reference_t<Work>*>(of))(piece, member); },
        static_cast<void*>(std::addressof(work)));
  }

 private:
  using Call = void (*)(void* of, int piece, int member);
  static constexpr int kPieceBits = 32;

  void share(int pieces, Call call, void* of);
  void help(int member);
  void take_pieces(std::uint64_t round, int member);
  template <class Done>
  void watch(Done&& done) const;

  int members_;
  const bool watches_;  // whether each member has a processor to watch on
  // A member's part of a round, in a line of the cache of its own.
  struct alignas(64) Part {
    // the round's number above, how many of the pieces nobody has taken below: a latecomer can't take another round's
    std::atomic<std::uint64_t> ticket{0};
    int end = 0;  // of its pieces; this and the work are read only by who has taken one: the round can't end before
  };
  std::array<Part, kMost> parts_;
  alignas(64) std::atomic<std::uint32_t> round_{0};  // what helpers sleep on
  alignas(64) std::atomic<int> open_{0};             // pieces of this round that are not done
  Call call_ = nullptr;
  void* of_ = nullptr;
  std::atomic<bool> ends_{false};
  std::vector<std::thread> helpers_;
};

/// As Team::run; without a team the caller does all pieces, in order, as member 0.
template <class Work>
void share_out(Team* team, int pieces, Work&& work) {
  if (team != nullptr && pieces > 1) {
    team->run(pieces, work);
  } else {
    for (int piece = 0; piece < pieces; ++piece) work(piece, 0);
  }
}

/// Shares out the places from 0 to count - 1 in ranges of so many: work(range, first, end) for each.
constexpr int kPlaces = 64;
constexpr int ranges_of(int count, int places = kPlaces) { return (count + places - 1) / places; }
template <class Work>
void share_out_places(Team* team, int count, Work&& work, int places = kPlaces) {
  share_out(team, ranges_of(count, places), [&](int range, int) {
    const int first = range * places;
    work(range, first, std::min(first + places, count));
  });
}

}  // namespace limber
