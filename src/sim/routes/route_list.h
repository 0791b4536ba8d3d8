// RouteList: the routes of a world, in order of creation. They are applied once per tick, before the behaviors: all
// sources are read before the first target is set. A route that reads the target of another one therefore gets its
// value of the tick before, and a cycle is a feedback with a lag of one tick. [sim]
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/routes/route.h"
#include "sim/world/object_list.h"

namespace limber::sim {

class WorldTransaction;

class RouteList {
 public:
  static constexpr std::size_t kMaxRoutes = 4096;

  RouteList(Store& store, NodeId parent);

  std::span<const std::unique_ptr<Route>> list() const { return routes_.list(); }
  Route* find(std::string_view name) const { return routes_.find(name); }
  Store& store() const { return store_; }
  /// The rollback log of guarded calls.
  void set_transaction(WorldTransaction& transaction) { transaction_ = &transaction; }

  /// Adds a route between two addresses or patterns (find_route_links()). What they name may not exist yet: the route
  /// waits for it. Errors: the name is taken or can't be printed, too many routes, text that is not an address.
  Result<Route*> add(std::string name, std::string from, std::string to);
  /// Gives a route other addresses.
  Result<void> connect(Route& route, std::string from, std::string to);
  /// Removes a route. In a guarded call it is hidden at once and destroyed when the call succeeds.
  void remove(Route& route);
  /// Destroys the routes that a guarded call has removed; called when it succeeds.
  void destroy_hidden();
  void move_to_front(const std::vector<Route*>& first);
  void clear();

  /// Reads all sources, then sets the targets.
  void apply(double dt);

  /// For checkpoints.
  void serialize(Archive& archive);
  std::uint64_t state_hash(std::uint64_t start) const;

 private:
  struct Target {
    PropertyRef ref;
    std::array<double, 4> values{};
    std::array<bool, 4> is_set{};
  };
  struct Hidden {
    std::unique_ptr<Route> route;
    NodeId id;
    std::size_t index;          // in the list
    std::size_t sibling_index;  // among its node's siblings
  };
  void show_last();
  void update_links();
  void find_targets();
  static void join(const Route& route, std::vector<Target>& targets);
  void set_target(Target& target);

  Store& store_;
  ObjectList<Route> routes_;
  WorldTransaction* transaction_ = nullptr;
  std::vector<Hidden> hidden_;
  std::vector<Target> targets_;
  std::uint64_t structure_version_ = 0;  // of the links
  bool outdated_ = true;                 // a route was added, removed, moved or connected again
};

}  // namespace limber::sim
