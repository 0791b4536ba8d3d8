// MocapList: the sources of motion capture of a world, in order of creation. Passes OSC messages to them. [sim]
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"
#include "sim/mocap/mocap_source.h"
#include "sim/world/object_list.h"

namespace limber::sim {

class MocapList {
 public:
  explicit MocapList(World& world) : world_(world) {}

  std::span<const std::unique_ptr<MocapSource>> list() const {
    return sources_ ? sources_->list() : std::span<const std::unique_ptr<MocapSource>>();
  }
  MocapSource* find(std::string_view name) const { return sources_ ? sources_->find(name) : nullptr; }
  /// Errors: the name is taken or can't be printed, a setup that is not valid, an address that another source receives.
  Result<MocapSource*> add(std::string name, std::shared_ptr<const MocapSetup> setup);
  /// Removes a source; not in guarded calls.
  void remove(const MocapSource& source);
  void move_to_front(const std::vector<MocapSource*>& first);
  void clear();

  /// Passes a message to the source that receives its address; returns nothing if none does. Error: the arguments don't
  /// fit.
  std::optional<Result<void>> accept(const Message& message);
  /// Moves all joints; call it before behaviors are stepped.
  void step(double dt);
  /// Hash of the sources, continued; `start` without sources.
  std::uint64_t state_hash(std::uint64_t start) const;

  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  struct Receiver {
    MocapSource* source = nullptr;
    std::size_t mapping = 0;
  };
  Result<void> check_addresses(const MocapSetup& setup) const;
  void index_addresses();

  World& world_;
  std::optional<ObjectList<MocapSource>> sources_;       // its node is added with the first source
  std::unordered_map<std::string, Receiver> receivers_;  // by address
  std::vector<Receiver> patterns_;                       // with <joint> in the address
  MocapSource* vmc_ = nullptr;
};

}  // namespace limber::sim
