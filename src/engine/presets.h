// Presets: the named states of a show, in order, and what messages do with them: store, recall, morph, delete. They
// outlive resets; what they hold on the disk is their keeper's. [sim]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "engine/hand.h"
#include "engine/morph.h"
#include "engine/outcome.h"
#include "engine/preset_keeper.h"
#include "engine/preset_taker.h"
#include "sim/world.h"

namespace limber {

class Presets {
 public:
  static constexpr std::size_t kMost = 10000;
  static constexpr double kLongest = 86400;  ///< Seconds of a morph.

  /// `hand` remembers what is recalled.
  explicit Presets(PerformerHand& hand) : hand_(hand) {}

  /// The presets of a scene, and who writes them to the file beside it.
  struct Book {
    PresetList list;
    std::unique_ptr<PresetKeeper> keeper;
    std::string file;  ///< The one name of it.
  };
  /// As the file beside the scene has them; what is wrong with it is logged. `failed` is told why a save failed.
  /// [any, no tick waits for it]
  static Book read(const std::string& scene, PresetFile::Owner owner, std::function<void(const std::string&)> failed);
  /// From now on it is this one; but a file that is open already stays as it is. The answer: the other one, which
  /// must go where a thread may wait for a disk. [sim]
  Book open(Book book);
  /// The same, whichever file is open. [sim]
  Book exchange(Book book);
  /// What "script" is from now on: as the scene's last good run describes everything.
  void scene_says(std::shared_ptr<const Preset> script) { script_ = std::move(script); }
  /// From now on it is another store; running morphs end.
  void forget_store();

  /// The one name of the file that they are kept in; empty: they are in none.
  const std::string& file() const { return file_; }

  /// /preset/store, recall, morph, delete, /list/presets, by its last word in small letters.
  Outcome execute(std::string_view what, const Message& message, World& world);
  /// Whether such a message would be taken, were those of `before` done.
  Result<void> check(const Message& message, std::span<const Message> before) const;
  /// A preset by its number from 1, over `seconds`; between two whole ones lies a blend of both.
  Result<void> recall_number(World& world, double number, double seconds);
  /// Running morphs stay where they are.
  void stop() { morphs_.clear(); }
  /// Morphs go on to where they are at that time.
  void advance(World& world);
  /// Makes ready for a store; once a tick.
  void prepare(const World& world) { taker_.prepare(world.store()); }
  /// The same at once, where no tick waits.
  void make_ready(const World& world) { taker_.make_ready(world.store()); }
  /// These values are in force, as after a recall; the answer: what was left out.
  Result<std::string> bring_back(World& world, const std::shared_ptr<const Preset>& values) {
    return go(world, Blend::of(values), 0, Easing::linear);
  }
  /// Every property as it is now.
  std::shared_ptr<const Preset> everything(const Store& store) { return *taker_.take(store, "everything", {}); }
  /// Whether that costs no more than copying.
  bool ready(const Store& store) const { return taker_.ready(store); }
  /// Whether all that was stored is on the disk.
  bool saved() const { return keeper_ == nullptr || keeper_->saved(); }
  /// A recall that the hand remembers, after a reset.
  void repeat(World& world, const Blend& blend);

  const PresetList& list() const { return list_; }
  /// Names, a line each.
  std::string_view names() const { return names_; }
  /// How far the running morph that has most to go is, 0 .. 1; 1 when none runs.
  double part(const World& world) const { return morphs_.part(world.time()); }
  /// Waits until all is on the disk. [any but sim]
  void finish_saving();

  /// What messages may change of it, between two ticks.
  struct Memory {
    PresetList list;
    Morphs morphs;
  };
  void keep(Memory& memory) const {
    memory.list = list_;
    memory.morphs = morphs_;
  }
  void bring_back(const Memory& memory);
  /// The presets are these.
  void take_list(PresetList list);
  /// While `on`, what was done once is done again: nothing is written to the disk.
  void do_again(bool on) { again_ = on; }

  /// A hand sets the row: it leaves the morphs that move it.
  void release(NodeId id, const Row& row) { morphs_.release(id, row); }

 private:
  Outcome store(const Message& message, World& world);
  Outcome recall(const Message& message, World& world);
  Outcome morph(const Message& message, World& world);
  Outcome erase(const Message& message);
  Outcome names_asked(const Message& message) const;

  const std::shared_ptr<const Preset>* find(std::string_view name) const;
  Result<std::shared_ptr<const Preset>> named(const Arg& arg) const;
  Result<Blend> at_number(double number);
  Blend between(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b, double amount);
  Result<std::string> go(World& world, const Blend& blend, double seconds, Easing easing);
  Result<std::shared_ptr<const PresetBinding>> bind(const Store& store, const Blend& blend);
  Error unknown(std::string_view name) const;
  void changed();
  void save();

  PerformerHand& hand_;
  bool again_ = false;
  PresetList list_;
  std::unique_ptr<PresetKeeper> keeper_;
  std::string file_;
  std::string names_;
  std::shared_ptr<const Preset> script_;
  PresetTaker taker_;
  Morphs morphs_;
  std::vector<std::shared_ptr<const PresetBinding>> bindings_;  // used lately
  struct Pair {
    std::shared_ptr<const Preset> a, b;
    Blend aligned;
  };
  std::vector<Pair> pairs_;  // blended lately
};

}  // namespace limber
