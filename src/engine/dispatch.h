// Dispatch: what a message means. The seed's messages and paths end in the same rows and the same door; everything is
// derived from the tables but a few irregular addresses. A refused message changes nothing. [sim]
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"
#include "engine/answers.h"
#include "engine/coerce.h"
#include "engine/grips.h"
#include "engine/health.h"
#include "engine/outcome.h"
#include "engine/presets.h"
#include "engine/select.h"
#include "params/catalog.h"
#include "sim/world.h"

namespace limber {

/// An address that comes from no row.
struct Irregular {
  std::string_view address;
  std::string_view takes;
  std::string_view doc;
};

class Dispatch {
 public:
  /// Work of all patterns between two ticks; see PatternBudget.
  static constexpr int kTickWork = 4 * PatternBudget::kMessage;

  /// Without presets their messages are refused. `more`: classes beside the world's own, whose things stand in a group
  /// of their name in each body; one with a class's own addresses goes before it.
  explicit Dispatch(World& world, Presets* presets = nullptr, std::span<const Table* const> more = {});

  /// Without it there is no answer to /list/health.
  void use(const Health& health) { health_ = &health; }

  Outcome execute(const Message& message);
  /// Near names are looked for in so many messages between two calls; others are refused with a shorter text.
  void begin_tick() {
    hints_.left = HintBudget::kPerTick;
    work_.left = kTickWork;
  }
  /// What hands hold in the picture pulls; before each step.
  void pull_grips() { grips_.pull(world_); }
  /// They let go of everything.
  void let_go() { grips_.clear(); }
  /// What hands hold, for a key state.
  Grips& grips() { return grips_; }
  /// What the last message set.
  struct Write {
    Place place;
    RowValues values;
  };
  std::span<const Write> written() const { return writes_; }

  /// The seed's address of a row: "/physics/part/mass"; empty where the class has none, or the row can't be set.
  static std::string seed_address(const Table& table, const Row& row);
  /// What is answered beside the tables' rows.
  static std::span<const Irregular> irregulars();

 private:
  /// A message that names things by arguments.
  struct ByName {
    const Table* table = nullptr;
    const Row* row = nullptr;
    Outcome (Dispatch::*irregular)(const Message&) = nullptr;
  };
  struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };
  template <class T>
  using ByText = std::unordered_map<std::string, T, TextHash, std::equal_to<>>;

  void add_class(const Table& table);
  Outcome execute_one(const Message& message);
  /// The one thing of a class that has one only, such as the world; else a null id.
  NodeId only_thing(const Table& table) const;
  Outcome by_name(const ByName& entry, const Message& message);
  Outcome by_path(const Message& message);
  Outcome by_pattern(const Message& message);
  /// Sets `places_` to the value; many leave out those that can't take it, a single one is refused with the reason.
  Outcome apply(bool single, std::span<const Arg> value);
  Outcome collect_writes(bool single, std::span<const Arg> value);
  /// Sets `writes_`.
  Outcome set_all();
  /// Does the action of each of `places_`.
  Outcome act(std::span<const Arg> value);
  Outcome part_force(const Message& message);
  Outcome part_hold(const Message& message);
  Outcome part_release(const Message& message);
  Outcome projection(const Message& message);
  Outcome behavior_parameter(const Message& message);
  Outcome list(const Message& message);
  Outcome scenes(const Message& message);
  Outcome health(const Message& message);
  Outcome get(const Message& message);
  Outcome gone(const Message& message);
  Outcome preset(const Message& message);
  Outcome take(const Message& message);

  World& world_;
  Presets* presets_;
  const Health* health_ = nullptr;
  Store& store_;
  HintBudget hints_;
  PatternBudget work_{kTickWork};  // left of this tick
  PatternBudget message_work_;     // left of this message
  Selector selector_{world_, hints_, message_work_};
  Answers answers_{world_, hints_, message_work_};
  ByText<ByName> by_name_;              // by plain address
  std::vector<std::string> addresses_;  // all of them, for near ones
  ByText<Place> paths_;                 // exact paths seen since the structure last changed
  std::uint64_t paths_version_ = 0;
  Grips grips_;
  std::vector<Place> places_;  // scratch: what the message means
  std::vector<Write> writes_;  // what it will write, once all of it is known to be right
};

}  // namespace limber
