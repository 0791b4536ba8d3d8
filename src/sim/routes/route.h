// Route: sends the value of a property to another one, in each tick, mapped from a range to a range. [sim]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory/archive.h"
#include "properties/store.h"
#include "sim/routes/route_link.h"

namespace limber::sim {

class RouteList;

/// How the output of a route joins those of the routes before it that have the same target.
enum class RouteCombine : std::uint8_t { sum, max, last };

class Route {
 public:
  static const PropertyTable& table();
  /// The most ticks by which an output lags, and the most numbers that are stored for it.
  static constexpr std::uint32_t kMaxLagTicks = 4096;
  static constexpr std::size_t kMaxLagNumbers = std::size_t{1} << 20;

  Route(RouteList& list, NodeId group, std::string name, std::string from, std::string to);
  ~Route();
  Route(const Route&) = delete;
  Route& operator=(const Route&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  const std::string& from() const { return from_; }
  const std::string& to() const { return to_; }
  /// Why it has no effect; empty: it works.
  const std::string& problem() const { return problem_; }
  /// Replaces both addresses.
  void connect(std::string from, std::string to);

  /// True if its links must be found again after the structure of the tree has changed.
  bool needs_links() const;
  /// Finds its links. A problem is logged once.
  void find_links();
  std::span<RouteLink> links() { return links_; }
  std::span<const RouteLink> links() const { return links_; }

  /// Reads its sources and computes the outputs. Without effect if it is not enabled or has no links.
  void compute(double dt);
  /// The outputs, those of one link after those of another; empty if it has no effect in this tick.
  std::span<const double> outputs() const;
  RouteCombine combine() const;
  /// Reports, once, that its output was rejected.
  void report_rejected(const std::string& why);

  /// For checkpoints.
  void serialize(Archive& archive);
  std::uint64_t state_hash(std::uint64_t start) const;

  // Callbacks of the properties.
  Result<void> act_remove(std::span<const double> args);
  std::string_view read_from() const { return from_; }
  std::string_view read_to() const { return to_; }
  std::string_view read_problem() const { return problem_; }

 private:
  Store& store() const;
  double setting(const Property* property) const;
  void read_sources();
  void map_outputs();
  void smooth(double dt);
  void delay(double dt);
  void publish(const Property* property, double value);
  void set_problem(std::string problem);

  RouteList& list_;
  NodeId id_;
  std::string from_, to_;
  std::string problem_;
  std::vector<RouteLink> links_;
  std::vector<double> outputs_;
  bool links_outdated_ = true;
  // what persists from tick to tick, besides its properties
  struct State {
    bool active = false;  // it had an effect in the last tick
    std::uint32_t lag = 0, next = 0;
    std::vector<double> smoothed;
    std::vector<double> delayed;  // the last `lag` outputs; the oldest one is at index `next`
  } state_;
};

}  // namespace limber::sim
