// TendonList: the tendons of a world, in order of creation. Each is a member of a body, and may pass through parts of
// others. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/tendons/tendon.h"

namespace limber::sim {

class TendonList {
 public:
  explicit TendonList(World& world) : world_(world) {}

  std::span<const std::unique_ptr<Tendon>> list() const { return tendons_; }
  /// Those of a body.
  std::vector<Tendon*> of(const Body& body) const;
  Tendon* find(const Body& body, std::string_view name) const;
  /// Adds a tendon to a body. Its length becomes its rest length. Errors: the name is taken or can't be printed, fewer
  /// than 2 or more than Tendon::kMaxPoints points, all on one part, positions that are not finite or too far away.
  Result<Tendon*> add(Body& body, std::string name, std::vector<Tendon::Point> points);
  /// Removes a tendon. In a guarded call it is hidden at once and destroyed when the call succeeds.
  void remove(Tendon& tendon);
  /// Removes the tendons that use a body that is to be removed.
  void remove_from(const Body& body);
  /// Moves these to the front of the list, in this order; the others follow in their previous order.
  void move_to_front(const std::vector<Tendon*>& first);
  void clear() { tendons_.clear(); }
  /// Adds the tendons of `source` to its copy. Points on `source` are placed on the copy's parts; a tendon with points
  /// on bodies of another world is omitted.
  void copy(const Body& source, Body& copy);

  /// Adds tendons to Bullet's world or removes them.
  void update();
  /// Publishes the readouts after a tick.
  void publish();

  /// A tendon without the body that it used, while that body is replaced.
  struct Detached {
    std::unique_ptr<Tendon> tendon;  ///< Null: a tendon of the replaced body, whose values are below.
    std::string name;
    std::vector<Tendon::Point> points;  ///< Part null: that of the replaced body with the name in `parts`.
    std::vector<std::string> parts;
    std::vector<double> values;  ///< Persistent ones.
    std::uint64_t explicitly_set = 0;
  };
  /// Extracts the tendons that use a body.
  std::vector<Detached> detach(const Body& body);
  /// Attaches them to the parts of the same names of `replacement`; tendons without such parts are destroyed. Those
  /// that `replacement` has already get the values.
  void attach(std::vector<Detached> detached, Body& replacement);

  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  Tendon& add_unchecked(Body& body, std::string name, std::vector<Tendon::Point> points);

  World& world_;
  std::vector<std::unique_ptr<Tendon>> tendons_;
};

}  // namespace limber::sim
