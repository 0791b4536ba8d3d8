// ImageMaker: makes an image of the store when one is asked for; of the simulation's time a hundredth at most goes into
// images, however many ask. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/latest.h"
#include "base/system/clock.h"
#include "engine/image.h"
#include "params/catalog.h"

namespace limber {

class ImageMaker {
 public:
  static constexpr double kShare = 0.01;  ///< Of the thread's time.
  static constexpr std::size_t kMostNotes = 4096;
  static constexpr std::uint64_t kNoteLasts = 64;  ///< Images that hold a note.

  /// `now` reads a clock in seconds, `spent` one of what the thread has had of a processor: a program that was
  /// suspended for an hour while it made an image owes nothing.
  explicit ImageMaker(Latest<Image>& out, double (*now)() = &system::clock_seconds,
                      double (*spent)() = &system::thread_seconds)
      : out_(out), now_(now), spent_(spent) {}

  /// The row was set by this hand, just now. Beyond kMostNotes the oldest are forgotten.
  void note(const Store& store, const Origin& origin, const Place& place, bool clamped);
  /// Makes an image that answers the first so many asks. False: nobody has asked since the last one, or the images
  /// before have cost enough for now. `snapshot` is what was published just now.
  bool make(const Store& store, const std::shared_ptr<const Snapshot>& snapshot, std::uint64_t asks);
  /// From now on it is another store.
  void forget_store();

 private:
  void fill_computed(const Store& store, Image& image) const;

  Latest<Image>& out_;
  double (*now_)();
  double (*spent_)();
  std::shared_ptr<const Tree> tree_;
  std::uint64_t structure_ = 0;
  std::uint64_t made_ = 0;
  std::uint64_t answered_ = 0;
  double next_ = 0;  // s
  struct Noted {
    WriteNote note;
    std::uint64_t made_then = 0;
  };
  std::vector<Noted> notes_;
  std::uint64_t noted_ = 0;
};

}  // namespace limber
