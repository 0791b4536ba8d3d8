// Edits: what hands have set, step by step, so that it can be undone and done again, whichever hand it was. Values that
// a scene's callbacks and behaviours set as time goes on are the performance, and no steps. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/hand.h"
#include "params/store.h"
#include "sim/world.h"

namespace limber {

class Edits {
 public:
  static constexpr std::size_t kMostSteps = 1000;
  static constexpr std::size_t kMostValues = std::size_t{1} << 20;  ///< Of all steps; the oldest go.
  /// Simulated seconds: a hand that sets a value again within them goes on with its step.
  static constexpr double kGesture = 0.5;

  /// What `hand` remembers for a reset is undone with the values.
  explicit Edits(PerformerHand& hand) : hand_(hand) {}

  /// What is set from here on is set by this hand: what comes in one tick, or at once while time stands still, is one
  /// step.
  void begin(const Origin& who, const World& world);
  /// The row was `before`, and is written, now or later on.
  void heard(const Store& store, NodeId id, const Row& row, bool later, const double* before);
  /// The tick's values are what they are: what was set to what it was is no step.
  void end(const Store& store);

  /// The newest step's values are what they were before it; but one that another hand goes on with is passed over, and
  /// so is what can't be undone any more. The error says that there is none.
  Result<void> undo(World& world);
  /// What was undone last is done again.
  Result<void> redo(World& world);
  /// What undo and redo would change, as people read it: "/physics/body/arm/part/tip/mass (console)"; empty: nothing.
  std::string_view undo_text() const { return undo_text_; }
  std::string_view redo_text() const { return redo_text_; }

  /// The things of another store, of the same names, are meant from now on.
  void follow(const Store& before, const Store& now);
  void clear();

 private:
  struct Edit {
    NodeId id;
    const Row* row = nullptr;
    std::size_t at = 0;  // of its value
  };
  struct Step {
    Origin who;
    std::uint64_t pass = 0;
    double time = 0;  // of the last that was set
    std::vector<Edit> edits;
    std::vector<double> values;  // that the rows do not have: before the step, or after it once it is undone
    PerformerHand::Before hand;
    bool settled = false;       // it is a step
    bool later = false;         // it sets values as time goes on
    std::size_t look_at = 256;  // so many edits, of which some may be of what has gone
  };
  // which rows a step that may go on has
  struct Open {
    struct Rows {
      std::uint32_t generation = 0;
      std::uint64_t step = 0;  // that they are of
      std::uint64_t rows = 0;
    };
    Step* step = nullptr;
    std::uint64_t number = 0;  // of the step
    std::vector<Rows> rows;    // by slot
    std::uint64_t used = 0;
    bool has(NodeId id, const Row& row) const;
    bool take(NodeId id, const Row& row);
  };
  using Steps = std::deque<std::unique_ptr<Step>>;

 public:
  /// All of it between two ticks, by itself.
  class Memory {
    friend class Edits;
    struct Going {
      std::size_t step = 0;  // among `done`
      std::uint64_t number = 0, used = 0;
    };
    std::vector<Step> done_, undone_;
    std::vector<std::optional<Going>> open_;
    std::uint64_t uses_ = 0, pass_ = 0;
    std::size_t values_ = 0;
    std::string undo_text_, redo_text_;

   public:
    /// About so many bytes.
    std::size_t size() const { return values_ * 2 * sizeof(double) + (done_.size() + undone_.size()) * sizeof(Step); }
  };
  std::shared_ptr<const Memory> memory() const;
  void bring_back(const Memory& memory);
  /// Another number whenever memory() may be something else.
  std::uint64_t version() const { return version_; }

 private:
  Open& open_for(NodeId id, const Row& row);
  Open& open_new();
  void settle(const Store& store);
  void forget_gone(Step& step, const Store& store);
  void trim();
  void drop(const Step* step);
  bool goes_on(const Step& step, const World& world) const;
  Result<void> exchange(Steps& from, Steps& to, World& world, const char* what);
  static void exchange(Step& step, Store& store, std::size_t& changed, std::size_t& gone);
  static bool differs(const Step& step, const Store& store);
  void tell_texts(const Store& store);

  PerformerHand& hand_;
  Steps done_, undone_;
  std::array<Open, 8> open_;
  std::uint64_t uses_ = 0;
  std::size_t values_ = 0;
  // of the hand that sets now
  Origin who_;
  std::uint64_t pass_ = 0;  // counts ticks, and those in which time stands still
  std::uint64_t structure_ = 0;
  double time_ = 0;
  bool running_ = false;
  Open* now_ = nullptr;
  bool quiet_ = false;  // it undoes itself
  bool told_ = true;
  std::uint64_t version_ = 0;
  std::string undo_text_, redo_text_;
};

}  // namespace limber
