// Dispatch: what a message means. The seed's messages and paths end in the same rows and the same door; everything is
// derived from the tables but a few irregular addresses. A refused message changes nothing. [sim]
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"
#include "engine/coerce.h"
#include "params/catalog.h"
#include "sim/world.h"

namespace limber {

/// What became of a message.
struct Outcome {
  enum class Kind : std::uint8_t {
    applied,
    answered,  ///< `answer` goes to the sender.
    refused,   ///< `error` says why; nothing was changed.
    unknown,   ///< No such address of Limber's; `error` names near ones.
  };
  Kind kind = Kind::applied;
  bool clamped = false;
  bool kept = false;  ///< It set a property: a performer's value, which a reset keeps.
  std::string error;
  std::vector<Message> answers;
};

class Dispatch {
 public:
  explicit Dispatch(World& world);

  Outcome execute(const Message& message);
  /// Every address that messages by name answer to: "/physics/part/mass" …, in order of the tables.
  std::vector<std::string> seed_addresses() const;

 private:
  /// A message that names things by arguments.
  struct ByName {
    const Table* table = nullptr;
    const Row* row = nullptr;
  };
  using Query = Outcome (Dispatch::*)(const Message&);

  Outcome by_name(const ByName& entry, const Message& message);
  Outcome by_path(const Message& message);
  Outcome part_force(const Message& message);
  Outcome list(const Message& message);
  Outcome get(const Message& message);
  Outcome apply(const std::vector<Place>& places, bool only_one, std::span<const Arg> value);
  Outcome act(const std::vector<Place>& places, std::span<const Arg> value);
  Result<std::vector<Place>> places_of(const ByName& entry, std::span<const Arg> names);
  Outcome unknown(const Message& message) const;
  std::span<const NodeId> elements(const Body& body, const Table& table) const;

  World& world_;
  Store& store_;
  std::unordered_map<std::string, ByName> by_name_;   // by plain address
  std::unordered_map<std::string, Query> irregular_;  // by plain address
};

}  // namespace limber
