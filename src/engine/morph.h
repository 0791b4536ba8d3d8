// Morphs: values on their way from where they are to a preset, moved on at each tick. A row that a hand sets on the way
// stays with that hand. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/preset.h"
#include "engine/preset_binding.h"

namespace limber {

/// How a way is gone: evenly; slow at both ends; slow at the beginning; slow at the end.
enum class Easing : std::uint8_t { linear, smooth, in, out };
std::optional<Easing> easing_of(std::string_view name);
/// "linear, smooth, in, out"
std::string_view easing_names();
/// How much of the way is gone after that part of the time, 0 .. 1 both.
double eased(Easing easing, double part);

class Morph {
 public:
  /// From the values as they are now. Only what differs moves; but the members of a group that moves do, since what is
  /// written to it goes to them. `time`, `seconds`: simulated.
  Morph(const Store& store, const PresetBinding& binding, Blend to, double time, double seconds, Easing easing);

  /// False: it is at its end, where every value is the preset's to the bit. Allocates nothing unless things came or
  /// went.
  bool advance(Store& store, double time);
  /// Tells the store's listener of its rows, before it is among those that the listener releases rows of.
  void announce(Store& store) const;
  /// From here on the row is somebody else's.
  void release(NodeId id, const Row& row);
  /// What part of its time is over, 0 .. 1.
  double part(double time) const;
  /// Whether any row is still its own.
  bool moves() const { return left_ > 0; }

 private:
  struct Step {
    const Row* row = nullptr;
    std::uint32_t at = 0;  // where it begins and, behind that, where it ends
    bool gone = false;     // its thing has no such row now
    bool over = false;
  };
  struct Mover {
    NodeId id;                // null: it is gone
    std::uint32_t thing = 0;  // number in the preset's shape
    std::uint32_t begin = 0;  // of its steps
    std::uint32_t end = 0;
  };
  void index(const Store& store);
  std::uint64_t go_on(Store& store, NodeId id, const Step& step, double amount) const;
  void find_again(const Store& store);
  bool find_again(const Store& store, const PresetBinding::Fit& fit, NodeId id, Step& step);
  bool take(const Store& store, NodeId id, const Step& step);

  Blend to_;
  std::vector<std::string> except_;
  double begin_ = 0;
  double seconds_ = 0;
  Easing easing_ = Easing::smooth;
  std::uint64_t structure_ = 0;
  std::vector<Mover> movers_;
  std::vector<Step> steps_;
  std::vector<double> values_;
  std::vector<std::uint32_t> mover_of_;  // by slot; their number: none
  std::size_t left_ = 0;
};

/// All that run at a time.
class Morphs {
 public:
  static constexpr std::size_t kMost = 64;

  bool full() const { return morphs_.size() >= kMost; }
  bool empty() const { return morphs_.empty(); }
  void begin(Morph morph) { morphs_.push_back(std::move(morph)); }
  void advance(Store& store, double time);
  void release(NodeId id, const Row& row);
  /// Of all rows that the binding has.
  void release(const PresetBinding& binding);
  void clear() { morphs_.clear(); }
  /// Of the one that has most to go; 1 when there is none.
  double part(double time) const;

 private:
  std::vector<Morph> morphs_;
};

}  // namespace limber
